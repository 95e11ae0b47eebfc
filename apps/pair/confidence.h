// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/pair/register_pair.h"

namespace corral {

/// How probable it is that a pose registers its pair (mean error of at most 5 pr), by its signals:
///
///   p = 1 / (1 + exp(-(slope (b_0 + sum b_k z_k) + shift)))     z_k = (s_k - mean_k) / deviation_k,  b_k >= 0
struct ConfidenceModel {
  ConfidenceSignals mean{}, deviation{}, weight{};  ///< a deviation of 0: the signal says nothing
  ConfidenceSignals low{}, high{};                  ///< of the poses that it was fitted to
  double bias = 0, slope = 1, shift = 0;            ///< b_0; the calibration
  int pairs = 0, groups = 0, right = 0;             ///< that it was fitted to

  double term(const ConfidenceSignals& signals, std::size_t k) const;  ///< b_k z_k
  double probability(const ConfidenceSignals& signals) const;

  /// The first signal beyond those of the poses that the model was fitted to; kSignals if there is none.
  std::size_t outside(const ConfidenceSignals& signals) const;

  /// The signals that weigh most against the pose and for it: those whose b_k z_k is the least and the largest.
  std::size_t weakest(const ConfidenceSignals& signals) const;
  std::size_t strongest(const ConfidenceSignals& signals) const;
};

/// A pose of this probability is one to trust; one below kDoubted is not to be used.
constexpr double kTrusted = 0.9, kDoubted = 0.5;

/// What to do with a pose of this probability: "trust it", "look at it" or "do not use it".
const char* verdict(double probability);

/// One for pairs of surfaces, one for tables of matches alone.
struct ConfidenceModels {
  ConfidenceModel surfaces, table;
};

/// A pose whose pair has a truth.
struct JudgedPose {
  ConfidenceSignals signals;
  bool is_right = false;
  std::string group;  ///< pairs of one object or scene are not independent
};

/// Logistic regression with a ridge of 1 on the b_k, none on b_0, by projected coordinate Newton steps; then slope and shift by
/// maximum likelihood on the poses of each group under the model of the others.
/// Source    [platt1999probabilistic] for the calibration.
/// Throws    InvalidInput: fewer than two groups, or fewer than ten right or ten wrong poses.
ConfidenceModel fit_confidence(const std::vector<JudgedPose>& poses);

/// What the poses of each group are given by the model of the others, with their own calibration left out too.
std::vector<double> held_out_probabilities(const std::vector<JudgedPose>& poses);

/// How good probabilities are.
struct Reliability {
  int pairs = 0, right = 0;
  double brier = 0;  ///< mean of (p - y)^2
  double area = 0;   ///< under the ROC curve; 0.5 where all are right, or wrong
  double calibration_error =
      0;  ///< over bins of equal counts, ten at most with 20 pairs at least: sum n_b / n |mean y - mean p|
  int kept = 0, kept_right = 0;  ///< poses with p >= 0.9
};
Reliability reliability(const std::vector<double>& probabilities, const std::vector<JudgedPose>& poses);

}  // namespace corral
