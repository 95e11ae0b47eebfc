// SPDX-License-Identifier: MIT
#include "apps/pair/table_truth_fit.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "kernel/evaluation.h"

namespace corral {
namespace {

constexpr double kCorrect_pr = 4;
constexpr int kFew = 3, kMany = 10, kTimes = 5;

int correct_under(const CorrespondenceSet& matches, const RigidTransform& pose) {
  const std::vector<bool> labels = label_correct(matches, pose, kCorrect_pr);
  return static_cast<int>(std::count(labels.begin(), labels.end(), true));
}

/// What else people mean by a pose.
std::vector<std::pair<std::string, RigidTransform>> readings_of(const RigidTransform& truth) {
  std::vector<std::pair<std::string, RigidTransform>> readings = {{"inverted", truth.inverse()}};
  readings.push_back({"transposed", {truth.rotation.transpose(), truth.translation}});
  for (const auto& [factor, name] : {std::pair(0.001, "0.001"), {1000.0, "1000"}}) {
    const RigidTransform scaled{truth.rotation, factor * truth.translation};
    readings.push_back({std::string("translation times ") + name, scaled});
    readings.push_back({std::string("inverted, translation times ") + name, scaled.inverse()});
  }
  return readings;
}

}  // namespace

TableTruthFit fit_truth(const CorrespondenceSet& matches, const RigidTransform& target_from_source) {
  const int given = correct_under(matches, target_from_source);
  std::pair<int, std::string> best{0, ""};
  for (const auto& [name, pose] : readings_of(target_from_source))
    if (const int correct = correct_under(matches, pose); correct > best.first) best = {correct, name};
  const std::string of = " of " + std::to_string(matches.size()) + " matches";
  if (best.first >= kMany && best.first > kTimes * given)
    return {best.second, "the truth fits " + best.second + ": " + std::to_string(best.first) + of +
                             " are then correct within 4 pr, " + std::to_string(given) + " as it stands"};
  return given >= kFew ? TableTruthFit{"fits", ""} : TableTruthFit();
}

}  // namespace corral
