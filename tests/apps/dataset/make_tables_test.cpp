// SPDX-License-Identifier: MIT
#include "apps/dataset/make_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/pairs/dataset_file.h"
#include "tests/support/small_study.h"

namespace corral::testing {
namespace {

using ::testing::HasSubstr;

TEST(MakeTables, HasTheMatchesOfItsSurfacesWithTruthsAndAttributes) {
  const Workplace place;
  put_small_dataset(place);
  const std::string make =
      "dataset make tables --data data/b3r -o tables --detector uniform --set uniform.spacing_pr=2.5";
  ASSERT_EQ(place.corral(make).status, 0);
  const Dataset made = read_dataset(place / "tables"), set = read_dataset(place / "data/b3r");
  EXPECT_EQ(made.name, "b3r-tables");
  ASSERT_EQ(made.pairs.size(), set.pairs.size());
  EXPECT_EQ(made.attributes, set.attributes);
  EXPECT_EQ(made.pairs[1].attributes, set.pairs[1].attributes);
  EXPECT_FALSE(made.pairs[1].has_surfaces());
  const std::string pair = set.pairs[1].name;
  ASSERT_EQ(place
                .corral("match data/b3r/" + set.pairs[1].source + " data/b3r/" + set.pairs[1].target +
                        " --resolution source --detector uniform --set uniform.spacing_pr=2.5 -o alone.csv")
                .status,
            0);
  EXPECT_EQ(place.text("tables/matches/" + pair + ".csv"), place.text("alone.csv"));
  EXPECT_EQ(place.corral("dataset check tables").status, 0);

  std::filesystem::remove(place / ("tables/matches/" + pair + ".csv"));
  EXPECT_EQ(place.corral(make + " --threads 1").status, 0) << "again";
  EXPECT_EQ(place.text("tables/matches/" + pair + ".csv"), place.text("alone.csv"));
  EXPECT_EQ(place.corral("dataset make tables --data data/b3r -o tables").status, 3) << "made in another way";
}

TEST(MakeTables, APairThatHasATableKeepsIt) {
  const Workplace place;
  put_small_dataset(place);
  ASSERT_EQ(place.corral("dataset make tables --data data/b3r -o first --detector uniform").status, 0);
  ASSERT_EQ(place.corral("dataset make tables --data first -o second").status, 0);
  for (const DatasetPair& pair : read_dataset(place / "second").pairs)
    EXPECT_EQ(place.text("second/" + pair.matches), place.text("first/" + pair.matches)) << pair.name;
  put_text(place / "first/truth/m1-0.05.txt", "1 0 0 1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(place.corral("dataset make tables --data first -o second").status, 3) << "with another truth";
}

TEST(MakeTables, LeadsToAScoreboard) {
  const Workplace place;
  put_small_dataset(place);
  const auto without = place.corral("scoreboard pack --data data/b3r -m gc -o mine");
  EXPECT_EQ(without.status, 3);
  EXPECT_THAT(without.err, HasSubstr("corral dataset make tables"));
  ASSERT_EQ(place.corral("dataset make tables --data data/b3r -o tables --detector uniform").status, 0);
  ASSERT_EQ(place.corral("scoreboard pack --data tables -m gc -o mine").status, 0);
  EXPECT_EQ(place.corral("scoreboard check mine --data tables").status, 0);
  ASSERT_EQ(place.corral("evaluate scoreboard --data tables -o study").status, 0);
  ASSERT_EQ(place.corral("scoreboard write study -o site --no-checks").status, 0);
  EXPECT_THAT(place.text("site/scoreboard-b3r-tables.html"), HasSubstr("gc"));
}

}  // namespace
}  // namespace corral::testing
