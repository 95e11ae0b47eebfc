// SPDX-License-Identifier: MIT
// What no grouper accepts, and that it says which column or option it was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grouping/registry.h"
#include "tests/support/grouper_variants.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::full_table;
using testing::GrouperVariant;
using ::testing::HasSubstr;
using testing::refusal_of;

class RefusedTable : public ::testing::TestWithParam<GrouperVariant> {
 protected:
  std::string refusal(const CorrespondenceSet& matches) const {
    return refusal_of([&] { GetParam().group(matches); });
  }
};

using Spoil = std::function<void(CorrespondenceSet&)>;

TEST_P(RefusedTable, RaggedColumnIsNamed) {
  const std::map<std::string, Spoil> spoils = {
      {"target_points", [](auto& t) { t.target_points = t.target_points.topRows(4).eval(); }},
      {"source_frames", [](auto& t) { t.source_frames.pop_back(); }},
      {"target_frames", [](auto& t) { t.target_frames.pop_back(); }},
      {"source_keypoints", [](auto& t) { t.source_keypoints.pop_back(); }},
      {"target_keypoints", [](auto& t) { t.target_keypoints.push_back(0); }},
      {"feature_distance", [](auto& t) { t.feature_distance = t.feature_distance.head(4).eval(); }},
      {"second_feature_distance", [](auto& t) { t.second_feature_distance = Eigen::VectorXd::Ones(6); }},
  };
  for (const auto& [column, spoil] : spoils) {
    CorrespondenceSet matches = full_table();
    spoil(matches);
    EXPECT_THAT(refusal(matches), HasSubstr(column));
  }
  CorrespondenceSet no_source = full_table();
  no_source.source_points.resize(0, 3);
  EXPECT_NE(refusal(no_source), "");
}

TEST_P(RefusedTable, NonFiniteColumnIsNamed) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    const std::map<std::string, Spoil> spoils = {
        {"source_points", [=](auto& t) { t.source_points(3, 1) = bad; }},
        {"target_points", [=](auto& t) { t.target_points(4, 2) = bad; }},
        {"source_frames", [=](auto& t) { t.source_frames[2](0, 0) = bad; }},
        {"target_frames", [=](auto& t) { t.target_frames[2](2, 1) = bad; }},
        {"feature_distance", [=](auto& t) { t.feature_distance(0) = bad; }},
        {"second_feature_distance", [=](auto& t) { t.second_feature_distance(4) = bad; }},
        {"resolution", [=](auto& t) { t.resolution = bad; }},
        {"source_centroid", [=](auto& t) { (*t.source_centroid)(1) = bad; }},
    };
    for (const auto& [column, spoil] : spoils) {
      CorrespondenceSet matches = full_table();
      spoil(matches);
      EXPECT_THAT(refusal(matches), HasSubstr(column)) << bad;
    }
  }
}

TEST_P(RefusedTable, ResolutionMustBePositive) {
  for (const double bad : {0.0, -1.0}) {
    CorrespondenceSet matches = full_table();
    matches.resolution = bad;
    EXPECT_THAT(refusal(matches), HasSubstr("resolution"));
  }
}

class RefusedOption : public ::testing::TestWithParam<std::string> {
 protected:
  const Grouper& grouper() const { return find_grouper(GetParam()); }
  std::string refusal(const OptionOverrides& overrides) const {
    return refusal_of([&] { grouper().configure(overrides); });
  }
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Grouper& grouper : groupers()) all.push_back(grouper.name);
  return all;
}

/// The number that follows some words of a text.
std::optional<double> number_after(const std::string& words, const std::string& text) {
  const auto place = text.find(words);
  if (place == std::string::npos) return std::nullopt;
  return std::stod(text.substr(place + words.size()));
}

/// Values on either side of the limits that an option says it has; none for a choice.
struct ValuesAtLimits {
  std::vector<std::string> accepted, refused;
};

ValuesAtLimits values_at_limits(const OptionValue& option) {
  ValuesAtLimits values;
  if (const auto low = number_after(" above ", option.accepted)) {
    values.refused = {to_text(*low), to_text(*low - 1)};
  } else if (const auto least = number_after(" of at least ", option.accepted)) {
    values.accepted = {to_text(*least)};
    values.refused = {to_text(*least - 1)};
  }
  if (values.refused.empty()) return values;
  for (const char* never : {"-1", "nan", "inf", "-inf"}) values.refused.push_back(never);
  if (const auto high = number_after(" at most ", option.accepted)) {
    values.accepted.push_back(to_text(*high));
    values.refused.push_back(to_text(*high + 1));
  }
  return values;
}

TEST_P(RefusedOption, ValueOutOfItsRangeIsNamed) {
  for (const OptionValue& option : grouper().options) {
    const bool number = option.accepted.find("number") != std::string::npos;
    const ValuesAtLimits values = values_at_limits(option);
    EXPECT_EQ(number, !values.refused.empty()) << option.name << " accepts " << option.accepted;
    for (const std::string& text : values.refused)
      EXPECT_THAT(refusal({{option.name, text}}), HasSubstr("option " + option.name)) << text;
    for (const std::string& text : values.accepted)
      EXPECT_NO_THROW(grouper().configure({{option.name, text}}).group(testing::harsh_table(30, 0.5, 1)))
          << option.name << " = " << text;
  }
}

TEST_P(RefusedOption, TextThatIsNoValueIsNamed) {
  for (const OptionValue& option : grouper().options)
    for (const std::string text : {"", "much", "-1x"})
      EXPECT_THAT(refusal({{option.name, text}}), HasSubstr(option.name)) << "'" << text << "'";
}

TEST_P(RefusedOption, UnknownNameIsAnsweredWithTheKnownOnes) {
  const std::string text = refusal({{"no_such_option", "1"}});
  EXPECT_THAT(text, HasSubstr("no_such_option"));
  EXPECT_THAT(text, HasSubstr(GetParam()));
  for (const OptionValue& option : grouper().options) EXPECT_THAT(text, HasSubstr(option.name));
}

INSTANTIATE_TEST_SUITE_P(Variants, RefusedTable, ::testing::ValuesIn(testing::grouper_variants()),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Groupers, RefusedOption, ::testing::ValuesIn(names()), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace corral
