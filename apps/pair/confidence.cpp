// SPDX-License-Identifier: MIT
#include "apps/pair/confidence.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "apps/runtime/embedded_files.h"
#include "apps/runtime/text_table.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

const EmbeddedFiles& embedded_confidence();

namespace {

constexpr double kRidge = 1, kRest = 1e-9;
constexpr int kMostSweeps = 20000, kFewest = 10;

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

double term(const ConfidenceModel& model, const ConfidenceSignals& signals, std::size_t k) {
  return model.deviation[k] > 0 ? model.weight[k] * (signals[k] - model.mean[k]) / model.deviation[k] : 0;
}

double logit(const ConfidenceModel& model, const ConfidenceSignals& signals) {
  double sum = model.bias;
  for (std::size_t k = 0; k < kSignals; ++k) sum += term(model, signals, k);
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

std::string list(const ConfidenceSignals& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + to_text(value);
  return text + "]";
}

std::string table_text(const std::string& name, const ConfidenceModel& model) {
  return "\n[" + name + "]\npairs = " + std::to_string(model.pairs) + "\ngroups = " + std::to_string(model.groups) +
         "\nright = " + std::to_string(model.right) + "\nmean = " + list(model.mean) +
         "\ndeviation = " + list(model.deviation) + "\nlow = " + list(model.low) + "\nhigh = " + list(model.high) +
         "\nweight = " + list(model.weight) + "\nbias = " + to_text(model.bias) + "\nslope = " + to_text(model.slope) +
         "\nshift = " + to_text(model.shift) + "\n";
}

ConfidenceModel read_model(const TomlTable& root, const std::string& name) {
  const auto table = root.table(name);
  if (!table) root.fail(name, "expected a table [" + name + "]");
  table->only({"pairs", "groups", "right", "mean", "deviation", "low", "high", "weight", "bias", "slope", "shift"});
  const auto values = [&](const char* key) {
    const std::vector<double> found = table->numbers(key);
    if (found.size() != kSignals) table->fail(key, "expected " + std::to_string(kSignals) + " numbers");
    ConfidenceSignals signals;
    std::copy(found.begin(), found.end(), signals.begin());
    return signals;
  };
  const auto value = [&](const char* key) {
    const auto found = table->number(key);
    if (!found) table->fail(key, "expected a number");
    return *found;
  };
  ConfidenceModel model;
  model.mean = values("mean"), model.deviation = values("deviation"), model.weight = values("weight");
  model.low = values("low"), model.high = values("high");
  model.bias = value("bias"), model.slope = value("slope"), model.shift = value("shift");
  model.pairs = static_cast<int>(value("pairs")), model.groups = static_cast<int>(value("groups"));
  model.right = static_cast<int>(value("right"));
  return model;
}

}  // namespace

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

std::string confidence_sentence(const ConfidenceModel& model, const ConfidenceSignals& signals) {
  const double probability = model.probability(signals);
  const std::size_t beyond = model.outside(signals);
  return std::string(verdict(probability)) + ": probability " + fixed(probability, 3) +
         " that it registers the pair, as on the " + std::to_string(model.pairs) +
         " pairs that this was learned from; most for it: " + kSignalNames[model.strongest(signals)] +
         ", least: " + kSignalNames[model.weakest(signals)] +
         (beyond < kSignals ? std::string("; outside of what those pairs had: ") + kSignalNames[beyond] : "");
}

std::size_t ConfidenceModel::weakest(const ConfidenceSignals& signals) const {
  std::size_t found = 0;
  for (std::size_t k = 1; k < kSignals; ++k)
    if (term(*this, signals, k) < term(*this, signals, found)) found = k;
  return found;
}

std::size_t ConfidenceModel::strongest(const ConfidenceSignals& signals) const {
  std::size_t found = 0;
  for (std::size_t k = 1; k < kSignals; ++k)
    if (term(*this, signals, k) > term(*this, signals, found)) found = k;
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

std::string confidence_text(const ConfidenceModels& models) {
  std::string names;
  for (const char* name : kSignalNames) names += (names.empty() ? "" : ", ") + std::string(name);
  return "# How probable it is that a pose of 'corral register' is right, by its signals: " + names +
         ".\n# Written by 'corral calibrate'.\n" + table_text("surfaces", models.surfaces) +
         table_text("table", models.table);
}

ConfidenceModels parse_confidence(const std::string& path, const std::string& text) {
  const TomlTable root = TomlTable::parse(path, text);
  root.only({"surfaces", "table"});
  return {read_model(root, "surfaces"), read_model(root, "table")};
}

const ConfidenceModels& built_in_confidence() {
  static const ConfidenceModels models =
      parse_confidence("confidence.toml", embedded_confidence().at("confidence.toml"));
  return models;
}

}  // namespace corral
