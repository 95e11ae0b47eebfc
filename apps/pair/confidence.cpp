// SPDX-License-Identifier: MIT
#include "apps/pair/confidence.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kRidge = 1, kRest = 1e-9;
constexpr int kMostSweeps = 20000, kFewest = 10;

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

double logit(const ConfidenceModel& model, const ConfidenceSignals& signals) {
  double sum = model.bias;
  for (std::size_t k = 0; k < kSignals; ++k) sum += model.term(signals, k);
  return sum;
}

int right_in(const std::vector<JudgedPose>& poses) {
  return static_cast<int>(
      std::count_if(poses.begin(), poses.end(), [](const JudgedPose& pose) { return pose.is_right; }));
}

std::set<std::string> groups_of(const std::vector<JudgedPose>& poses) {
  std::set<std::string> groups;
  for (const JudgedPose& pose : poses) groups.insert(pose.group);
  return groups;
}

void standardize(const std::vector<JudgedPose>& poses, ConfidenceModel& model) {
  const auto n = static_cast<double>(poses.size());
  for (std::size_t k = 0; k < kSignals; ++k) {
    double sum = 0, squares = 0;
    model.low[k] = std::numeric_limits<double>::infinity();
    model.high[k] = -model.low[k];
    for (const JudgedPose& pose : poses) {
      sum += pose.signals[k];
      model.low[k] = std::min(model.low[k], pose.signals[k]);
      model.high[k] = std::max(model.high[k], pose.signals[k]);
    }
    model.mean[k] = sum / n;
    for (const JudgedPose& pose : poses) squares += std::pow(pose.signals[k] - model.mean[k], 2);
    model.deviation[k] = model.high[k] > model.low[k] ? std::sqrt(squares / n) : 0;
  }
}

/// The b_k, without the calibration: each coordinate in turn by a Newton step with the largest second derivative that the
/// logistic function can have (1/4 for each pose), which never overshoots.
ConfidenceModel fit_weights(const std::vector<JudgedPose>& poses) {
  ConfidenceModel model;
  standardize(poses, model);
  const auto n = static_cast<Eigen::Index>(poses.size());
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(n, kSignals);
  Eigen::VectorXd y(n), eta = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const JudgedPose& pose = poses[static_cast<std::size_t>(i)];
    y(i) = pose.is_right;
    for (std::size_t k = 0; k < kSignals; ++k)
      if (model.deviation[k] > 0)
        z(i, static_cast<Eigen::Index>(k)) = (pose.signals[k] - model.mean[k]) / model.deviation[k];
  }
  const auto slope = [&](const auto& column) {
    double sum = 0;
    for (Eigen::Index i = 0; i < n; ++i) sum += column(i) * (y(i) - logistic(eta(i)));
    return sum;
  };
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double moved = 0;
    const double step = slope(ones) / (0.25 * static_cast<double>(n));
    model.bias += step;
    eta.array() += step;
    moved = std::abs(step);
    for (std::size_t k = 0; k < kSignals; ++k) {
      const auto column = z.col(static_cast<Eigen::Index>(k));
      const double curvature = 0.25 * column.squaredNorm() + kRidge;
      const double next = std::max(0.0, model.weight[k] + (slope(column) - kRidge * model.weight[k]) / curvature);
      eta += (next - model.weight[k]) * column;
      moved = std::max(moved, std::abs(next - model.weight[k]));
      model.weight[k] = next;
    }
    if (moved < kRest) break;
  }
  return model;
}

/// Slope and shift by maximum likelihood for these logits, with the targets of [platt1999probabilistic].
void calibrate(const std::vector<double>& logits, const std::vector<JudgedPose>& poses, ConfidenceModel& model) {
  const double right = right_in(poses), wrong = static_cast<double>(poses.size()) - right;
  const double yes = (right + 1) / (right + 2), no = 1 / (wrong + 2);
  const auto cost = [&](const Eigen::Vector2d& at) {
    double sum = 0;
    for (std::size_t i = 0; i < logits.size(); ++i) {
      const double x = at(0) * logits[i] + at(1), t = poses[i].is_right ? yes : no;
      sum += std::log1p(std::exp(-std::abs(x))) + std::max(x, 0.0) - t * x;
    }
    return sum;
  };
  Eigen::Vector2d at(1, 0);
  for (int round = 0; round < 100; ++round) {
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    Eigen::Matrix2d hessian = 1e-9 * Eigen::Matrix2d::Identity();
    for (std::size_t i = 0; i < logits.size(); ++i) {
      const Eigen::Vector2d x(logits[i], 1);
      const double p = logistic(at.dot(x));
      gradient += (p - (poses[i].is_right ? yes : no)) * x;
      hessian += p * (1 - p) * x * x.transpose();
    }
    Eigen::Vector2d step = -hessian.ldlt().solve(gradient);
    const double before = cost(at);
    for (int half = 0; half < 40 && !(cost(at + step) <= before); ++half) step /= 2;
    if (!(cost(at + step) <= before)) break;
    at += step;
    if (step.norm() < kRest) break;
  }
  if (!(at(0) > 0)) at = {0, std::log((right + 1) / (wrong + 1))};  // the logits say nothing of other groups
  model.slope = at(0);
  model.shift = at(1);
}

std::vector<JudgedPose> without(const std::vector<JudgedPose>& poses, const std::string& group) {
  std::vector<JudgedPose> others;
  for (const JudgedPose& pose : poses)
    if (pose.group != group) others.push_back(pose);
  return others;
}

}  // namespace

double ConfidenceModel::term(const ConfidenceSignals& signals, std::size_t k) const {
  return deviation[k] > 0 ? weight[k] * (signals[k] - mean[k]) / deviation[k] : 0;
}

double ConfidenceModel::probability(const ConfidenceSignals& signals) const {
  return logistic(slope * logit(*this, signals) + shift);
}

std::size_t ConfidenceModel::outside(const ConfidenceSignals& signals) const {
  std::size_t k = 0;
  while (k < kSignals && signals[k] >= low[k] && signals[k] <= high[k]) ++k;
  return k;
}

const char* verdict(double probability) {
  return probability >= kTrusted ? "trust it" : probability >= kDoubted ? "look at it" : "do not use it";
}

std::size_t ConfidenceModel::weakest(const ConfidenceSignals& signals) const {
  std::size_t found = 0;
  for (std::size_t k = 1; k < kSignals; ++k)
    if (term(signals, k) < term(signals, found)) found = k;
  return found;
}

std::size_t ConfidenceModel::strongest(const ConfidenceSignals& signals) const {
  std::size_t found = 0;
  for (std::size_t k = 1; k < kSignals; ++k)
    if (term(signals, k) > term(signals, found)) found = k;
  return found;
}

ConfidenceModel fit_confidence(const std::vector<JudgedPose>& poses) {
  const std::set<std::string> groups = groups_of(poses);
  const int right = right_in(poses), wrong = static_cast<int>(poses.size()) - right;
  if (groups.size() < 2) throw InvalidInput("confidence", "groups", std::to_string(groups.size()), "two at least");
  if (right < kFewest || wrong < kFewest)
    throw InvalidInput("confidence", "poses", std::to_string(right) + " right and " + std::to_string(wrong) + " wrong",
                       "ten of each at least");
  std::vector<double> logits(poses.size());
  for (const std::string& group : groups) {
    const ConfidenceModel others = fit_weights(without(poses, group));
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (poses[i].group == group) logits[i] = logit(others, poses[i].signals);
  }
  ConfidenceModel model = fit_weights(poses);
  calibrate(logits, poses, model);
  model.pairs = static_cast<int>(poses.size()), model.groups = static_cast<int>(groups.size()), model.right = right;
  return model;
}

std::vector<double> held_out_probabilities(const std::vector<JudgedPose>& poses) {
  std::vector<double> probabilities(poses.size());
  for (const std::string& group : groups_of(poses)) {
    const ConfidenceModel others = fit_confidence(without(poses, group));
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (poses[i].group == group) probabilities[i] = others.probability(poses[i].signals);
  }
  return probabilities;
}

Reliability reliability(const std::vector<double>& probabilities, const std::vector<JudgedPose>& poses) {
  Reliability found;
  found.pairs = static_cast<int>(poses.size());
  found.right = right_in(poses);
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probabilities[a] < probabilities[b]; });
  double above = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double y = poses[i].is_right, p = probabilities[i];
    found.brier += (p - y) * (p - y) / static_cast<double>(poses.size());
    if (p >= 0.9) ++found.kept, found.kept_right += poses[i].is_right;
    if (!poses[i].is_right) continue;
    for (std::size_t j = 0; j < poses.size(); ++j)
      if (!poses[j].is_right) above += p > probabilities[j] ? 1 : p == probabilities[j] ? 0.5 : 0;
  }
  const double pairs_of_both = static_cast<double>(found.right) * (found.pairs - found.right);
  found.area = pairs_of_both > 0 ? above / pairs_of_both : 0.5;
  const std::size_t bins = std::max<std::size_t>(1, std::min<std::size_t>(10, poses.size() / 20));
  for (std::size_t bin = 0; bin < bins; ++bin) {
    double sum = 0;
    for (std::size_t i = bin * order.size() / bins; i < (bin + 1) * order.size() / bins; ++i)
      sum += poses[order[i]].is_right - probabilities[order[i]];
    found.calibration_error += std::abs(sum) / static_cast<double>(std::max<std::size_t>(poses.size(), 1));
  }
  return found;
}

}  // namespace corral
