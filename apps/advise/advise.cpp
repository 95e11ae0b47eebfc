// SPDX-License-Identifier: MIT
#include "apps/advise/advise.h"

#include <algorithm>
#include <numeric>

#include "apps/pair/confidence.h"
#include "apps/pair/load_pair.h"
#include "apps/pair/methods.h"
#include "apps/pair/portfolio.h"
#include "apps/results/statistics.h"
#include "apps/runtime/workers.h"
#include "kernel/error.h"

namespace corral {
namespace {

constexpr double kMostBytes = 4e9, kThresholdPr = 4;

SampleRange spread_of(const std::vector<double>& values) {
  return {quantile_of(values, 0.5), *std::min_element(values.begin(), values.end()),
          *std::max_element(values.begin(), values.end())};
}

std::optional<SampleRange> spread_if_any(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return spread_of(values);
}

/// Evenly spaced places in a list.
std::vector<std::size_t> sample_of(std::size_t count, int most) {
  const std::size_t wanted = std::min(count, static_cast<std::size_t>(most));
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < wanted; ++i) places.push_back((2 * i + 1) * count / (2 * wanted));
  return places;
}

MethodRecord evaluate_on(const LoadedPair& pair, const std::string& method) {
  if (method == kRegister && pair.meshes) return evaluate_registration(pair.matches, *pair.surfaces(), pair.truth);
  return evaluate_method(method, find_method(method).configure({}), pair.matches, pair.truth, 1, kMostBytes);
}

/// The pose of 'register' as a truth, if it is sure.
void judge_by_registration(LoadedPair& pair) {
  const MethodRecord record = evaluate_on(pair, kRegister);
  if (!record.confidence || *record.confidence < kTrusted) return;
  const RigidTransform& pose = *record.pose.target_from_source;
  pair.truth = pair.meshes
                   ? pair_truth(pair.meshes->source, pair.meshes->target, pose, pair.matches.resolution, kThresholdPr)
                   : table_truth(pair.matches, pose, kThresholdPr);
}

int correct_of(const LoadedPair& pair) {
  const auto labels = label_correct(pair.matches, pair.truth->target_from_source, kThresholdPr);
  return static_cast<int>(std::count(labels.begin(), labels.end(), true));
}

/// What is added up over the pairs of one method.
struct MethodSums {
  int registered = 0, judged = 0;
  double precision = 0, recall = 0;
  std::vector<double> times;

  void add(const MethodRecord& record, bool is_judged) {
    if (record.failure.empty() && record.time_ms) times.push_back(*record.time_ms);
    if (!is_judged) return;
    ++judged;
    registered += is_registered(record.errors);
    if (!record.score || !record.failure.empty()) return;
    precision += record.score->precision.value_or(0);
    recall += record.score->recall.value_or(0);
  }

  MethodOutcome outcome(const std::string& method, double budget_ms) const {
    MethodOutcome found{method, registered, judged, 0, 0, 0, {}, {}, {}, !times.empty()};
    const auto [low, high] = wilson_interval(registered, judged);
    found.low = low, found.high = high;
    if (judged > 0) {
      found.success = static_cast<double>(registered) / judged;
      found.precision = precision / judged, found.recall = recall / judged;
    }
    if (!times.empty()) found.median_ms = quantile_of(times, 0.5);
    if (found.median_ms && *found.median_ms > budget_ms) found.is_affordable = false;
    return found;
  }
};

/// Other ways to match, by name.
std::vector<std::pair<std::string, MatchSettings>> other_matchings(const MatchSettings& usual) {
  std::vector<std::pair<std::string, MatchSettings>> others;
  MatchSettings dense = usual;
  const OptionValue length = keypoint_length(usual);
  dense.options[dense.detector][length.name] = to_text(parse_double(length.value).value() / 2);
  others.emplace_back("keypoints at half the spacing", dense);
  for (const Detector& detector : detectors()) {
    if (detector.name == usual.detector) continue;
    MatchSettings other = usual;
    other.detector = detector.name, other.options.erase(usual.detector);
    others.emplace_back("detector " + detector.name, other);
  }
  for (const Descriptor& descriptor : descriptors()) {
    if (descriptor.name == usual.descriptor) continue;
    MatchSettings other = usual;
    other.descriptor = descriptor.name, other.options.erase(usual.descriptor);
    others.emplace_back("descriptor " + descriptor.name, other);
  }
  return others;
}

class Adviser {
 public:
  Adviser(const Dataset& dataset, const AdviceOptions& options, const AdviceObserver& observer)
      : dataset_(dataset), options_(options), observer_(observer) {
    for (const Grouper& method : methods()) names_.push_back(method.name);
    sums_.resize(names_.size());
    sample_ = sample_of(dataset.pairs.size(), options.sample);
    advice_.by_truth = std::any_of(dataset.pairs.begin(), dataset.pairs.end(),
                                   [](const DatasetPair& pair) { return !pair.truth.empty(); });
  }

  Advice run() {
    for (const std::size_t place : sample_) {
      const DatasetPair& pair = dataset_.pairs[place];
      begin(pair.name, 0.8 / static_cast<double>(sample_.size()));
      try {
        try_methods(pair);
      } catch (const std::runtime_error& error) {
        advice_.facts.failures.push_back(pair.name + ": " + error.what());
      } catch (const std::invalid_argument& error) {
        advice_.facts.failures.push_back(pair.name + ": " + error.what());
      }
    }
    if (advice_.facts.sampled == 0)
      throw InvalidInput("advise", "pairs", advice_.facts.failures.front(), "a pair that can be read and matched");
    finish();
    if (advice_.facts.judged > 0 && !kept_.empty()) try_other_matchings();
    return std::move(advice_);
  }

 private:
  void begin(const std::string& step, double share) const {
    if (observer_) observer_(step, share);
  }

  void try_methods(const DatasetPair& given) {
    LoadedPair pair = load_pair(dataset_, given, options_.matching);
    ++advice_.facts.sampled;
    matches_.push_back(pair.matches.size());
    resolutions_.push_back(pair.matches.resolution);
    if (pair.meshes) points_.push_back(static_cast<double>(pair.meshes->source.vertices.rows()));
    if (!pair.truth) judge_by_registration(pair);
    const bool is_judged = pair.truth.has_value();
    if (is_judged) {
      ++advice_.facts.judged;
      const auto labels = label_correct(pair.matches, pair.truth->target_from_source, kThresholdPr);
      const int correct = correct_of(pair);
      if (pair.matches.size() > 0) correct_.push_back(100.0 * correct / pair.matches.size());
      if (pair.meshes)
        overlaps_.push_back(100.0 * static_cast<double>(pair.truth->overlap.rows()) /
                            static_cast<double>(pair.meshes->source.vertices.rows()));
      if (const auto share = frame_repeatability(pair.matches, pair.truth->target_from_source, labels).share())
        frames_.push_back(100 * *share);
      perfect_.add(evaluate_bounds(pair.matches, *pair.truth).front(), true);
    }
    for (std::size_t i = 0; i < names_.size(); ++i) sums_[i].add(evaluate_on(pair, names_[i]), is_judged);
    if (is_judged && pair.meshes && given.matches.empty() &&
        kept_.size() < static_cast<std::size_t>(options_.tried_otherwise))
      kept_.emplace_back(&given, std::move(pair));
  }

  double preferred(const MethodOutcome& method) const {
    return options_.prefer == Preference::Precision ? method.precision.value_or(0)
           : options_.prefer == Preference::Recall  ? method.recall.value_or(0)
                                                    : method.success;
  }

  void finish() {
    DataFacts& facts = advice_.facts;
    facts.pairs = static_cast<int>(dataset_.pairs.size());
    facts.points = spread_if_any(points_), facts.resolution = spread_if_any(resolutions_);
    facts.matches = spread_if_any(matches_), facts.correct_percent = spread_if_any(correct_);
    facts.overlap_percent = spread_if_any(overlaps_), facts.frames_percent = spread_if_any(frames_);
    advice_.perfect = perfect_.outcome("oracle", options_.budget_ms);
    for (std::size_t i = 0; i < names_.size(); ++i)
      advice_.methods.push_back(sums_[i].outcome(names_[i], options_.budget_ms));
    std::stable_sort(advice_.methods.begin(), advice_.methods.end(),
                     [&](const MethodOutcome& a, const MethodOutcome& b) {
                       if (a.is_affordable != b.is_affordable) return a.is_affordable;
                       if (preferred(a) != preferred(b)) return preferred(a) > preferred(b);
                       const double never = std::numeric_limits<double>::infinity();
                       return a.median_ms.value_or(never) < b.median_ms.value_or(never);
                     });
  }

  void try_other_matchings() {
    const std::string& chosen = advice_.methods.front().method;
    int correct = 0, registered = 0;
    for (const auto& [given, pair] : kept_)
      correct += correct_of(pair), registered += is_registered(evaluate_on(pair, chosen).errors);
    const auto ways = other_matchings(options_.matching);
    for (const auto& [name, settings] : ways) {
      OtherMatching other{name, 0, 0, 0, registered};
      int correct_so = 0;
      for (const auto& [given, pair] : kept_) {
        begin(name, 0.2 / static_cast<double>(ways.size() * kept_.size()));
        LoadedPair again = load_pair(dataset_, *given, settings);
        again.truth = pair.truth;
        ++other.pairs;
        correct_so += correct_of(again);
        other.registered += is_registered(evaluate_on(again, chosen).errors);
      }
      other.correct_ratio = static_cast<double>(correct_so) / std::max(correct, 1);
      advice_.others.push_back(other);
    }
  }

  const Dataset& dataset_;
  const AdviceOptions& options_;
  const AdviceObserver& observer_;
  std::vector<std::string> names_;
  std::vector<MethodSums> sums_;
  MethodSums perfect_;
  std::vector<std::size_t> sample_;
  std::vector<double> points_, resolutions_, matches_, correct_, overlaps_, frames_;
  std::vector<std::pair<const DatasetPair*, LoadedPair>> kept_;
  Advice advice_;
};

}  // namespace

std::vector<std::string> Advice::ties() const {
  std::vector<std::string> names;
  for (std::size_t i = 1; i < methods.size(); ++i)
    if (methods[i].is_affordable && methods[i].high >= methods.front().success) names.push_back(methods[i].method);
  return names;
}

Advice advise(const Dataset& dataset, const AdviceOptions& options, const AdviceObserver& observer) {
  return Adviser(dataset, options, observer).run();
}

}  // namespace corral
