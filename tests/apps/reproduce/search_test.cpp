// SPDX-License-Identifier: MIT
// The search on tables that the readings make by arithmetic.
#include "apps/reproduce/search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/reproduce/reproduction.h"
#include "apps/reproduce/reproduction_files.h"
#include "tests/support/simulated_run.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Scores;

/// Three points with two readings each; none changes matches but the last.
std::vector<OpenPoint> three_points() {
  const auto reading = [](const char* name) {
    Reading made;
    made.name = name, made.text = "-", made.from = "neither", made.evidence = "-";
    return made;
  };
  const auto point = [&](const char* name, const char* grouper) {
    OpenPoint made{name, "?", {reading("text"), reading("other")}};
    made.readings[1].options[grouper]["x"] = "1";
    return made;
  };
  std::vector<OpenPoint> points = {point("a", "ss"), point("b", "nnsr"), point("c", "gc")};
  points[2].readings[1].options.clear();
  points[2].readings[1].matching["normals"] = "origin";
  return points;
}

ClaimBook book_of(const std::string& claims) {
  return parse_claims("claims.toml",
                      "methods = [\"ss\", \"nnsr\", \"gc\"]\ntau = 0.01\ntime_tau = 0.05\nleast_pairs = 3\n"
                      "slips = []\n" +
                          claims);
}

std::string claim(const std::string& id, const std::string& rule) {
  return "[[claim]]\nid = \"" + id + "\"\ntext = \"" + id +
         "\"\nparts = [{ experiment = \"noise\", of = \"precision\", take = \"mean\", is = [\"" + rule + "\"] }]\n";
}

/// Precisions of ss, nnsr and gc by combination; noisy over the pairs.
using Precisions = std::function<std::vector<double>(const Combination&)>;

TableSource source_of(const Precisions& precisions, double noise = 0) {
  return [=](const Combination& combination, Half half) {
    StudyFolder run;
    const std::vector<double> means = precisions(combination);
    testing::add_experiment(run, {"noise",
                                  "set",
                                  {testing::step(0.1)},
                                  half == Half::All ? 24 : 12,
                                  false,
                                  0.2,
                                  [&](const std::string& method, const StudyLevel&, int pair) {
                                    const std::size_t place = method == "ss" ? 0 : method == "nnsr" ? 1 : 2;
                                    const double precision =
                                        means[place] + noise * ((pair * 7 + static_cast<int>(place) * 5) % 11 - 5);
                                    return Scores{precision, 0.5};
                                  }});
    JudgedTables judged;
    judged.tables = experiment_tables(run);
    judged.agreement.assign(1, std::vector<RowNumbers>(1));
    judged.keypoints.assign(1, std::vector<RowNumbers>(1));
    return judged;
  };
}

struct Case {
  const std::vector<OpenPoint> points = three_points();
  const ClaimBook book;
  Reproduction run(const Precisions& precisions, double noise = 0) const {
    return reproduce(points, book, source_of(precisions, noise));
  }
};

TEST(Search, TakesWhatHoldsMoreStatementsAndNothingElse) {
  const Case both{three_points(), book_of(claim("A", "ss > 0.5") + claim("B", "nnsr > 0.5"))};
  const Reproduction made = both.run([](const Combination& of) {
    return std::vector<double>{of[0] ? 0.7 : 0.3, of[1] ? 0.2 : 0.4, 0.5};
  });
  EXPECT_THAT(made.found.all.combination, ElementsAre(1, 0, 0));
  EXPECT_EQ(made.found.held_out.holds, 1);
  EXPECT_EQ(made.text.held_out.holds, 0);
  EXPECT_EQ(made.classes[0], StatementClass::Depends);
  EXPECT_EQ(made.classes[1], StatementClass::Never);
  EXPECT_THAT(made.decides[0], ElementsAre(0));
  EXPECT_TRUE(made.decides[1].empty());
  EXPECT_THAT(preset_toml(made), HasSubstr("[options]\nss.x = 1\n"));
}

TEST(Search, ChangesTwoPointsAtOnceWhereNeitherHelpsAlone) {
  const Case one{three_points(), book_of(claim("A", "ss > nnsr"))};
  const Reproduction made = one.run([](const Combination& of) {
    return std::vector<double>{of[0] && of[1] ? 0.7 : 0.3, 0.5, 0.5};
  });
  EXPECT_THAT(made.found.all.combination, ElementsAre(1, 1, 0));
  EXPECT_EQ(made.classes[0], StatementClass::Never);  // of the readings alone
  EXPECT_TRUE(made.is_bound[0]);
}

TEST(Search, ComesToTheMatchesToo) {
  const Case one{three_points(), book_of(claim("A", "gc > 0.5") + claim("B", "gc > ss"))};
  const Reproduction made = one.run([](const Combination& of) {
    return std::vector<double>{of[0] ? 0.1 : 0.9, 0.5, of[2] ? 0.6 : 0.2};
  });
  EXPECT_THAT(made.found.all.combination, ElementsAre(1, 0, 1));
}

TEST(Search, DoesNotWinByNoise) {
  const Case one{three_points(), book_of(claim("A", "ss > 0.5") + claim("B", "ss > 0.501"))};
  const auto hardly = [](const Combination& of) { return std::vector<double>{of[0] ? 0.5011 : 0.5001, 0.5, 0.5}; };
  EXPECT_THAT(one.run(hardly).found.all.combination, ElementsAre(1, 0, 0));
  // The step that a perfect measurement takes is not taken where pairs drawn anew often say the opposite.
  const Case other{three_points(), book_of(claim("A", "ss > 0.5") + claim("B", "ss < 0.49") + claim("C", "ss > 0.51"))};
  const auto risky = [](const Combination& of) { return std::vector<double>{of[0] ? 0.515 : 0.4, 0.5, 0.5}; };
  EXPECT_THAT(other.run(risky).found.all.combination, ElementsAre(1, 0, 0));
  EXPECT_THAT(other.run(risky, 0.05).found.all.combination, ElementsAre(0, 0, 0));
}

TEST(Search, NamesStatementsThatExcludeEachOther) {
  const Case two{three_points(), book_of(claim("A", "ss > 0.5") + claim("B", "ss < 0.5"))};
  const Reproduction made = two.run([](const Combination& of) {
    return std::vector<double>{of[0] ? 0.7 : 0.3, 0.5, 0.5};
  });
  EXPECT_THAT(made.never_together, ElementsAre(std::pair(0, 1)));
  EXPECT_EQ(made.classes[0], StatementClass::Depends);
  EXPECT_THAT(reproduction_text(made), HasSubstr("2 statements hold in at least one"));
  EXPECT_THAT(matrix_csv(made), HasSubstr("A,depends,fails,holds,"));
}

}  // namespace
}  // namespace corral
