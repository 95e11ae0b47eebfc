// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "apps/pair/match_settings.h"
#include "io/pairs/dataset_file.h"
#include "kernel/parallel.h"

namespace corral {

/// What a method is wanted for; the words of --prefer, the first is the default.
enum class Preference { Success, Precision, Recall };
constexpr std::array<const char*, 3> kPreferences = {"success", "precision", "recall"};

struct AdviceOptions {
  int sample = 20;  ///< most pairs that are tried, evenly spaced through the list
  double budget_ms = std::numeric_limits<double>::infinity();  ///< most median time of the method
  Preference prefer = Preference::Success;
  MatchSettings matching;
  int tried_otherwise = 6;  ///< most pairs that are matched again in other ways
};

/// A number over the pairs of the sample.
struct SampleRange {
  double median = 0, low = 0, high = 0;  ///< low, high: the least and the largest
};

/// What the sampled pairs are like; what needs surfaces or a truth is absent without.
struct DataFacts {
  int pairs = 0, sampled = 0;
  int judged = 0;                     ///< with a truth, or a pose that is sure without one
  std::vector<std::string> failures;  ///< pairs that could not be read or matched, with the reason
  std::optional<SampleRange> points, resolution, matches, correct_percent, overlap_percent, frames_percent;
};

/// How a method did on the judged pairs.
struct MethodOutcome {
  std::string method;
  int registered = 0, pairs = 0;            ///< pairs: judged
  double success = 0, low = 0, high = 0;    ///< share registered, Wilson interval of 95 %
  std::optional<double> precision, recall;  ///< means over the pairs
  std::optional<double> median_ms;          ///< over all sampled pairs; absent if it answered on none
  bool is_affordable = true;                ///< answered, within the budget
};

/// The same pairs matched in another way.
struct OtherMatching {
  std::string name;  ///< "keypoints at half the spacing"
  int pairs = 0;
  double correct_ratio = 0;        ///< of the sums of correct matches, to those of the matching as it is
  int registered = 0, before = 0;  ///< pairs that the chosen method registers, so and as it is
};

struct Advice {
  bool by_truth = false;  ///< truths of the data; else poses of 'register' that are sure
  DataFacts facts;
  std::vector<MethodOutcome> methods;  ///< affordable ones first, the best first
  MethodOutcome perfect;               ///< all correct matches
  std::vector<OtherMatching> others;   ///< of pairs with surfaces

  /// Affordable methods that the sample does not tell from the first: their interval holds its share.
  std::vector<std::string> ties() const;
};

/// Called when a step begins, with its name and its share of all.
using AdviceObserver = std::function<void(const std::string& step, double share)>;

/// Runs every grouper, "auto" and "register" on a sample of a data set and says which to use. The order is by the preferred mean,
/// then by time, then as groupers() lists them. A pair without a truth is judged by the pose of 'register' where that has a
/// probability of 0.9 at least (confidence.h), and not at all where it has not.
/// Deterministic but for times. Throws InvalidInput if no pair could be read and matched.
Advice advise(const Dataset& dataset, const AdviceOptions& options, const AdviceObserver& observer = {});

/// One screen of text; its JSON is that of all fields.
std::string advice_text(const Advice& advice, const AdviceOptions& options);
Json to_json(const Advice& advice);

}  // namespace corral
