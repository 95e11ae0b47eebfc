// SPDX-License-Identifier: MIT
#include "apps/pair/conformance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "grouping/registry.h"
#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Workplace;

std::vector<std::string> broken(const GroupFunction& group) {
  std::vector<std::string> names;
  for (const ConformanceCheck& check : check_conformance(group)) {
    if (check.holds == false) names.push_back(check.name);
    EXPECT_EQ(check.table.has_value(), check.holds == false) << check.name;
  }
  return names;
}

/// GC, with its answer spoiled.
template <class Spoil>
GroupFunction spoiled(const Spoil& spoil) {
  return [spoil, gc = find_grouper("gc").configure({}).group](const CorrespondenceSet& matches) {
    GroupingResult found = gc(matches);
    spoil(matches, found);
    return found;
  };
}

TEST(Conformance, EveryGrouperConforms) {
  for (const Grouper& grouper : groupers()) {
    const std::vector<std::string> names = broken(grouper.configure({}).group);
    if (grouper.name == "ransac" || grouper.name == "st")  // it draws rows by their numbers, or has ties to break
      EXPECT_THAT(names, ElementsAre("order of the rows")) << grouper.name;
    else
      EXPECT_THAT(names, IsEmpty()) << grouper.name;
  }
}

TEST(Conformance, NamesWhatIsBroken) {
  EXPECT_THAT(broken(spoiled([](const CorrespondenceSet& matches, GroupingResult&) {
                if (matches.size() == 0) throw std::runtime_error("no rows");
              })),
              ElementsAre("empty table"));
  EXPECT_THAT(broken(spoiled([](const CorrespondenceSet& matches, GroupingResult& found) {
                if (matches.size() == 300) found.selected.push_back(300);
              })),
              ::testing::Contains("rows and scores"));
  EXPECT_THAT(broken(spoiled([](const CorrespondenceSet& matches, GroupingResult& found) {
                if (matches.size() > 3) found.scores = {0.5};
              })),
              ::testing::Contains("rows and scores"));
  int calls = 0;
  EXPECT_THAT(broken(spoiled([&calls](const CorrespondenceSet& matches, GroupingResult& found) {
                if (matches.size() == 400 && ++calls % 2 == 0) found.selected = {0};
              })),
              ::testing::Contains("same answer twice"));
  EXPECT_THAT(broken(spoiled([](const CorrespondenceSet& matches, GroupingResult& found) {
                if (matches.size() > 250) found.selected = {0, 1, 2};
              })),
              ElementsAre("order of the rows"));
  EXPECT_THAT(broken(spoiled([](const CorrespondenceSet& matches, GroupingResult& found) {
                if (matches.resolution > 1) found.selected.clear();
              })),
              ElementsAre("unit of length"));
  EXPECT_THAT(broken(spoiled([](const CorrespondenceSet& matches, GroupingResult& found) {
                if (matches.size() > 250 && matches.resolution == 1) {
                  Indices kept;
                  for (const int row : found.selected)
                    if (matches.target_points(row, 0) > matches.target_points(row, 1)) kept.push_back(row);
                  found.selected = kept;
                }
              })),
              ::testing::Contains("motion of the target"));
  EXPECT_THAT(broken([](const CorrespondenceSet& matches) {
                GroupingResult found;
                found.selected.resize(static_cast<std::size_t>(matches.size()));
                std::iota(found.selected.begin(), found.selected.end(), 0);
                return found;
              }),
              ElementsAre("a match that is not finite", "easy table"));
}

TEST(Conformance, IsACommandForAnyMethod) {
  const Workplace place;
  const auto good = place.corral("conformance gc --json");
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_EQ(good.json()[0]["method"], "gc");
  EXPECT_EQ(good.json()[0]["verdict"], "holds");
  const auto bad = place.corral("conformance --external 'all=sh all.sh {matches} {group}' -o broken");
  EXPECT_EQ(bad.status, 4);
  place.put("all.sh", "echo 0 > $2\n");
  const auto first = place.corral("conformance --external 'first=sh all.sh {matches} {group}' -o broken");
  EXPECT_EQ(first.status, 4);
  EXPECT_THAT(first.out, HasSubstr("row"));
  EXPECT_TRUE(std::filesystem::exists(place / "broken/first-order-of-the-rows.csv"));
  EXPECT_EQ(place.corral("group broken/first-order-of-the-rows.csv -m gc").status, 0);
  EXPECT_EQ(place.corral("conformance").status, 2);
  EXPECT_EQ(place.corral("conformance gcc").status, 2);
}

}  // namespace
}  // namespace corral
