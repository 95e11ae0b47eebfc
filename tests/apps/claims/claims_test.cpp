// SPDX-License-Identifier: MIT
// Verdicts on simulated runs.
#include "apps/claims/claims.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "apps/claims/claim_outcomes.h"
#include "apps/claims/claim_report.h"
#include "apps/runtime/workers.h"
#include "apps/study/specification.h"
#include "kernel/error.h"
#include "kernel/random.h"
#include "tests/io/scratch.h"
#include "tests/support/simulated_run.h"

namespace corral {
namespace {

using testing::bin;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Scores;
using testing::step;

using Verdicts = std::map<std::string, ClaimVerdict>;

Verdicts judge(const std::vector<StudyFolder>& runs) {
  Verdicts verdicts;
  for (const ClaimVerdict& verdict : judge_claims(built_in_claims(), tables_of(runs))) verdicts[verdict.id] = verdict;
  return verdicts;
}

/// One experiment in which a method's precision and recall are given by its name and level.
StudyFolder run_with(const std::string& name, const std::vector<StudyLevel>& levels,
                     const std::function<Scores(const std::string&, double)>& scores, int pairs = 6) {
  StudyFolder run;
  testing::add_experiment(
      run, {name, "set", levels, pairs, name == "threshold", 0.2,
            [&](const std::string& method, const StudyLevel& level, int) { return scores(method, level.middle()); }});
  return run;
}

TEST(Claims, AllAreRead) {
  const ClaimBook book = built_in_claims();
  ASSERT_EQ(book.claims.size(), 75u);
  for (int i = 1; i <= 75; ++i)
    EXPECT_EQ(book.claims[static_cast<std::size_t>(i - 1)].id,
              i <= 69 ? "C" + std::to_string(i) : "D" + std::to_string(i - 69));
  for (const Claim& claim : book.claims) EXPECT_FALSE(claim.text.empty()) << claim.id;
  EXPECT_EQ(book.slips.size(), 10u);
  EXPECT_EQ(book.tau, 0.01);
  EXPECT_EQ(book.least_pairs, 5);
  EXPECT_EQ(book.methods, testing::all_methods());
}

TEST(Claims, ThoseOfTheSuccessorNameTheNineAndTheBaseline) {
  const ClaimBook book = read_claims(CORRAL_SOURCE_DIR "/paper/claims-2019.toml");
  EXPECT_EQ(book.methods.size(), 10u);
  EXPECT_EQ(book.methods.back(), "baseline");
  for (const Claim& claim : book.claims)
    for (const ClaimPart& part : claim.parts)
      for (const std::string& name : part.experiments) EXPECT_NO_THROW(experiment_text(name)) << claim.id;
}

TEST(Claims, AllAreDecidedOnACompleteRun) {
  const testing::ScratchFolder folder;
  StudyFolder run = testing::simulated_study(3);
  run.folder = folder.path();
  testing::write_run(run);
  int decided[2] = {};
  const std::vector<StudyFolder> runs = {read_study(run.folder)};
  const std::vector<StudyResults> tables = tables_of(runs);
  const std::vector<ClaimVerdict> verdicts = judge_claims(built_in_claims(), tables);
  EXPECT_EQ(claims_text(judge_claims(built_in_claims(), tables, workers(3)), {}), claims_text(verdicts, {}));
  for (const ClaimVerdict& verdict : verdicts) {
    EXPECT_NE(verdict.verdict, Verdict::Undecidable) << verdict.id << " " << verdict.parts.front().reason;
    EXPECT_TRUE(verdict.margin) << verdict.id;
    EXPECT_FALSE(verdict.experiments.empty()) << verdict.id;
    EXPECT_EQ(verdict.figures.size(), verdict.experiments.size()) << verdict.id;
    ++decided[verdict.verdict == Verdict::Holds];
  }
  EXPECT_GT(decided[0], 20);  // random scores bear out few findings
  EXPECT_GT(decided[1], 5);
}

TEST(Claims, AreTheSameEachTime) {
  const StudyFolder run = testing::simulated_study(4);
  const Verdicts once = judge({run}), again = judge({run});
  for (const auto& [id, verdict] : once) {
    EXPECT_EQ(verdict.changed, again.at(id).changed) << id;
    EXPECT_EQ(verdict.margin, again.at(id).margin) << id;
  }
}

TEST(Claims, AreUndecidableWithoutTheirExperiment) {
  const Verdicts verdicts = judge({run_with("noise", {step(0.05)}, [](auto&, double) { return Scores{0.5, 0.5}; })});
  EXPECT_EQ(verdicts.at("C9").verdict, Verdict::Undecidable);
  EXPECT_THAT(verdicts.at("C9").parts[0].reason, HasSubstr("no experiment density"));
  EXPECT_EQ(verdicts.at("C2").verdict, Verdict::Undecidable);
  EXPECT_THAT(verdicts.at("C2").parts[0].reason, HasSubstr("no level of noise from 0.35 to 0.45"));
  EXPECT_FALSE(verdicts.at("C2").margin);
  EXPECT_EQ(verdicts.at("C7").verdict, Verdict::Undecidable);  // one level has no trend
  EXPECT_EQ(verdicts.at("C6").verdict, Verdict::Fails);        // but it can be compared at
  EXPECT_THAT(verdicts.at("C59").parts[0].reason, HasSubstr("no experiment clutter"));
}

TEST(Claims, DropLevelsWithFewPairs) {
  const auto scores = [](const std::string& method, double) { return Scores{method == "nnsr" ? 0.9 : 0.5, 0.5}; };
  EXPECT_EQ(judge({run_with("noise", {step(0.4)}, scores, 5)}).at("C2").verdict, Verdict::Holds);
  EXPECT_EQ(judge({run_with("noise", {step(0.4)}, scores, 4)}).at("C2").verdict, Verdict::Undecidable);
}

TEST(Claims, AreUndecidableWithoutAMethod) {
  StudyFolder run = run_with("noise", {step(0.4)}, [](const std::string& method, double) {
    return Scores{method == "nnsr" ? 0.9 : 0.5, 0.5};
  });
  const auto is_st = [](const StudyRecord& record) { return record.method == "st"; };
  run.records.erase(std::remove_if(run.records.begin(), run.records.end(), is_st), run.records.end());
  EXPECT_EQ(judge({run}).at("C1").verdict, Verdict::Undecidable);  // the two best of all
  EXPECT_EQ(judge({run}).at("C2").verdict, Verdict::Holds);        // says nothing of ST
}

TEST(Claims, FindTheTwoBestAndAllowTies) {
  const auto with_st = [](double st) {
    return run_with("noise", {step(0.1), step(0.2)}, [st](const std::string& method, double) {
      const double score = method == "ransac" ? 0.8 : method == "si" ? 0.7 : method == "st" ? st : 0.5;
      return Scores{score, score};
    });
  };
  EXPECT_NEAR(*judge({with_st(0.6)}).at("C1").margin, 0.11, 1e-12);
  EXPECT_EQ(judge({with_st(0.71)}).at("C1").verdict, Verdict::Holds);  // a tie: exactly tau
  EXPECT_EQ(judge({with_st(0.715)}).at("C1").verdict, Verdict::Fails);
  EXPECT_NEAR(*judge({with_st(0.715)}).at("C1").margin, -0.005, 1e-12);
}

TEST(Claims, FollowTrendsOfLevels) {
  const auto scores = [](const std::string& method, double density) {
    if (method == "nnsr" || method == "si") return Scores{0.9, density};  // recall 0.9 to 0.1
    return Scores{0.9, 0.6 + 0.1 * density};
  };
  const std::vector<StudyLevel> levels = {step(0.9), step(0.5), step(0.1)};
  const Verdicts verdicts = judge({run_with("density", levels, scores)});
  EXPECT_EQ(verdicts.at("C12").verdict, Verdict::Holds);
  EXPECT_NEAR(verdicts.at("C12").parts[0].margin, 0.4, 1e-12);            // 0.8 lost, 0.4 asked
  EXPECT_NEAR(verdicts.at("C12").parts[1].margin, 8 / 9.0 - 0.5, 1e-12);  // of 0.9
  EXPECT_EQ(verdicts.at("C12").parts[1].id, "C12b");
  EXPECT_EQ(verdicts.at("C14").verdict, Verdict::Holds);
  EXPECT_EQ(verdicts.at("C15").verdict, Verdict::Fails);        // the inlier ratio is the same everywhere
  EXPECT_EQ(verdicts.at("C11").verdict, Verdict::Undecidable);  // no level 0.3
  EXPECT_EQ(judge({run_with("density", {step(0.9), step(0.5)}, scores)}).at("C12").verdict, Verdict::Undecidable);
}

TEST(Claims, ThresholdsRaisePrecisionOnTheSamePairs) {
  const auto rising = [](const std::string&, double threshold) { return Scores{0.05 * threshold, 0.5}; };
  StudyFolder run = run_with("threshold", {step(1), step(2), step(3)}, rising);
  EXPECT_NEAR(*judge({run}).at("C38").margin, 0.05, 1e-12);
  // Pairs that have no right match at 1 pr are excluded there; that they count at 2 pr is no fall of precision.
  for (StudyRecord& record : run.records)
    if (record.level == "1" && record.pair == "pair0")
      record.true_matches = 0;
    else if (record.pair == "pair0")
      record.precision = 0;
  EXPECT_EQ(judge({run}).at("C38").verdict, Verdict::Holds);
  const auto is_lost = [](const StudyRecord& record) { return record.level == "2" && record.pair == "pair2"; };
  run.records.erase(std::remove_if(run.records.begin(), run.records.end(), is_lost), run.records.end());
  EXPECT_NEAR(*judge({run}).at("C38").margin, 0.04, 1e-12);  // of the four pairs left and the one of 0
  for (StudyRecord& record : run.records)
    if (record.level == "3" && record.method == "gc") record.precision = 0.04;
  EXPECT_EQ(judge({run}).at("C38").verdict, Verdict::Fails);
}

TEST(Claims, OfTimesNeedNoFivePairs) {
  StudyFolder run;
  testing::add_times(run, {250, 500, 1000, 1500, 2000, 3000}, [](const std::string& method, double size) {
    if (method == "st") return 1e-8 * size * size * size;
    if (method == "gc") return 1e-6 * size * size;
    if (method == "ransac") return 0.01 * size;
    return method == "hough" ? 0.0001 * size : method == "nnsr" ? 0.00005 * size : 0.002 * size;
  });
  const Verdicts verdicts = judge({run});
  for (const char* id : {"C50", "C51", "C52", "C53", "C54", "C55", "C57", "C63", "C65"})
    EXPECT_EQ(verdicts.at(id).verdict, Verdict::Holds) << id;
  EXPECT_NEAR(*verdicts.at("C57").margin, 0.3, 1e-9);            // slope 2 within 1.7 .. 2.3
  EXPECT_NEAR(*verdicts.at("C63").margin, std::log(3.0), 1e-9);  // 270 ms against 10 times 9 ms
  EXPECT_NEAR(*verdicts.at("C55").margin, std::log(0.9 / 0.3), 1e-9);
}

TEST(Claims, AreWeakWhereNoiseDecides) {
  RandomStream stream(7);
  std::map<int, double> draws;
  for (int i = 0; i < 100; ++i) draws[i] = stream.uniform();
  const auto run_by = [&](double lead) {
    StudyFolder run;
    testing::add_experiment(
        run, {"noise", "b3r", {step(0.1)}, 20, false, 0.2, [&](const std::string& method, const StudyLevel&, int pair) {
                return Scores{method == "nnsr" ? 0.5 + lead : draws[pair], 0.5};
              }});
    return run;
  };
  const ClaimVerdict close = judge({run_by(0)}).at("C6"), clear = judge({run_by(0.4)}).at("C6");
  EXPECT_TRUE(close.is_weak) << close.changed;
  EXPECT_EQ(clear.verdict, Verdict::Holds);
  EXPECT_FALSE(clear.is_weak) << clear.changed;
  EXPECT_LT(clear.changed, 0.01);
}

TEST(Claims, AreSensitiveWhereTheMeasureDecides) {
  // RANSAC and SI: F1 of 0.6; ST: precision 1 and recall 0.4, F1 of 0.571 but (P + R) / 2 of 0.7.
  const auto scores = [](const std::string& method, double) {
    if (method == "ransac" || method == "si") return Scores{0.6, 0.6};
    return method == "st" ? Scores{1, 0.4} : Scores{0.2, 0.2};
  };
  const Verdicts verdicts = judge({run_with("noise", {step(0.1), step(0.2)}, scores)});
  EXPECT_EQ(verdicts.at("C1").verdict, Verdict::Holds);
  EXPECT_TRUE(verdicts.at("C1").is_sensitive);
  EXPECT_FALSE(verdicts.at("C6").is_sensitive);
}

TEST(Claims, OfManyPartsFailWithOne) {
  const auto scores = [](const std::string& method, double) { return Scores{method == "gc" ? 0.9 : 0.4, 0.4}; };
  const Verdicts verdicts = judge({run_with("clutter", {bin(65, 70)}, scores)});
  EXPECT_EQ(verdicts.at("C68").parts[0].verdict, Verdict::Holds);
  EXPECT_EQ(verdicts.at("C68").parts[1].verdict, Verdict::Undecidable);
  EXPECT_EQ(verdicts.at("C68").verdict, Verdict::Undecidable);
  EXPECT_THAT(verdicts.at("C68").experiments, ElementsAre("clutter", "overlap"));
  EXPECT_EQ(verdicts.at("C69").verdict, Verdict::Undecidable);
  const auto worse = [](const std::string&, double) { return Scores{0.9, 0.9}; };
  EXPECT_EQ(judge({run_with("clutter", {bin(65, 70)}, worse)}).at("C69").verdict, Verdict::Fails);  // whatever the rest
}

TEST(Claims, LookAtSeveralExperiments) {
  StudyFolder run;
  const auto add = [&](const std::string& name, double inlier_ratio, const std::map<std::string, double>& scores) {
    testing::add_experiment(run, {name,
                                  name,
                                  {bin(0, 0.1), bin(70, 75)},
                                  6,
                                  false,
                                  inlier_ratio,
                                  [&](const std::string& method, const StudyLevel&, int) {
                                    const double score = scores.at(method);
                                    return Scores{score, score};
                                  }});
  };
  const std::map<std::string, double> good = {{"ss", 0.8},  {"nnsr", 0.8},  {"ransac", 0.95}, {"st", 0.9},
                                              {"gc", 0.91}, {"hough", 0.7}, {"si", 0.6}};
  const std::map<std::string, double> poor = {{"ss", 0.1},  {"nnsr", 0.2},  {"ransac", 0.50}, {"st", 0.25},
                                              {"gc", 0.51}, {"hough", 0.5}, {"si", 0.3}};
  add("noise", 0.6, good);
  add("density", 0.6, good);
  for (const char* name : {"clutter", "occlusion", "overlap"}) add(name, 0.05, poor);
  const Verdicts verdicts = judge({run});
  EXPECT_NEAR(*verdicts.at("C17").margin, 0.2 - 0.01, 1e-12);  // 3DHV loses least
  EXPECT_NEAR(*verdicts.at("C60").margin, 0.25, 1e-12);        // NNSR loses 0.75, the median is SI's 0.5
  EXPECT_EQ(verdicts.at("C60").verdict, Verdict::Holds);
  EXPECT_NEAR(verdicts.at("C62").parts[0].margin, 0.9 - 0.85, 1e-12);
  EXPECT_NEAR(verdicts.at("C62").parts[1].margin, 0.3 - 0.25, 1e-12);
  // RANSAC is beaten nowhere, as GC's lead of 0.01 is no more than tau: 10 cells; GC and 3DHV tie with it in 6.
  EXPECT_EQ(*verdicts.at("C64").margin, 4);
  EXPECT_NEAR(verdicts.at("C66").parts[1].margin, 4 - (6 * 4 + 1 * 6) / 10.0, 1e-12);  // sixth on B3R, first elsewhere
  EXPECT_NEAR(*verdicts.at("C8").margin, 0.3, 1e-12);  // the same order: a correlation of 1
  EXPECT_EQ(verdicts.at("D6").verdict, Verdict::Holds);
  EXPECT_EQ(*verdicts.at("D1").margin, -300);  // 24 pairs
}

TEST(Claims, PutRunsTogether) {
  const auto scores = [](const std::string& method, double) { return Scores{method == "gc" ? 0.9 : 0.4, 0.4}; };
  const StudyFolder clutter = run_with("clutter", {bin(65, 70)}, scores),
                    overlap = run_with("overlap", {bin(30, 40)}, scores);
  EXPECT_EQ(judge({clutter, overlap}).at("C68").verdict, Verdict::Holds);
  EXPECT_THROW(judge({clutter, clutter}), IoError);
}

TEST(Claims, CanCountTheMatchesOfAllPairsTogether) {
  // One large pair decides: 900 of 1000 matches of SS are correct there, 1 of 10 in the five others; NNSR keeps half of each.
  StudyFolder run = run_with("noise", {step(0.1)}, [](auto&, double) { return Scores{0.5, 0.5}; });
  const auto set = [](StudyRecord& record, int selected, int correct, int right) {
    record.selected = selected, record.correct = correct, record.true_matches = right;
    record.precision = selected > 0 ? std::optional<double>(1.0 * correct / selected) : std::nullopt;
    record.recall = 1.0 * correct / right;
    record.f1 = 2.0 * correct / (selected + right);
  };
  const std::string large = run.records.front().pair;
  for (StudyRecord& record : run.records) {
    const bool is_large = record.pair == large;
    record.true_matches = is_large ? 1000 : 10;
    if (record.method == "ss") set(record, is_large ? 1000 : 10, is_large ? 900 : 1, is_large ? 1000 : 10);
    if (record.method == "nnsr") set(record, is_large ? 1000 : 0, is_large ? 500 : 0, is_large ? 1000 : 10);
  }
  ClaimBook book = parse_claims("mine.toml", R"(
methods = ["ss", "nnsr"]
tau = 0.01
time_tau = 0.05
least_pairs = 5
slips = []
[[claim]]
id = "P"
text = "P"
parts = [{ experiment = "noise", of = "precision", take = "mean", is = ["ss > 0"] }]
[[claim]]
id = "R"
text = "R"
parts = [{ experiment = "noise", of = "recall", take = "mean", is = ["ss > 0"] }]
[[claim]]
id = "F"
text = "F"
parts = [{ experiment = "noise", of = "f1", take = "mean", is = ["ss > 0"] }]
[[claim]]
id = "N"
text = "N"
parts = [{ experiment = "noise", of = "precision", take = "mean", is = ["nnsr > 0"] }]
)");
  const std::vector<ExperimentTable> tables = experiment_tables(run);
  ClaimStudy study;
  study.add(claim_table(book, run, tables.front()));
  const auto margins = [&](const Averaging& averaging) {
    std::vector<double> values;
    for (const ClaimOutcome& outcome : ClaimOutcomes(book, study, averaging).outcomes())
      values.push_back(outcome.margin);
    return values;
  };
  using ::testing::DoubleNear;
  const auto near = [](double value) { return DoubleNear(value, 1e-12); };
  const double mean = (0.9 + 5 * 0.1) / 6, pooled = 905 / 1050.0;
  EXPECT_THAT(margins({}), ElementsAre(near(mean), near(mean), near(mean), near(0.5 / 6)));
  EXPECT_THAT(margins({false, true, false}), ElementsAre(near(pooled), near(pooled), near(pooled), near(0.5)));
  EXPECT_THAT(margins({false, false, true}), ElementsAre(near(mean), near(mean), near(mean), near(0.5)));
}

}  // namespace
}  // namespace corral
