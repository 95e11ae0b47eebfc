// SPDX-License-Identifier: MIT
#include "apps/dataset/measure_dataset.h"

#include <algorithm>
#include <cmath>

#include "apps/pair/match_pair.h"
#include "apps/runtime/text_table.h"
#include "io/matches/matches_file.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/number_text.h"
#include "kernel/surface/scan/visibility.h"

namespace corral {
namespace {

constexpr double kCorrectMatch = 4;  // pr

std::optional<double> percent_without(const std::optional<double>& shared) {
  if (!shared) return std::nullopt;
  return 100 * (1 - *shared);
}

CorrespondenceSet matches_of(const Dataset& dataset, const SweptPair& pair) {
  if (!pair.pair.matches.empty()) try {
      return read_matches(dataset.path(pair.pair.matches));
    } catch (const IoError&) {  // 'corral dataset check' says why
      return {};
    }
  MatchSettings settings;
  settings.resolution = to_text(pair_resolution(dataset, pair.source.resolution, pair.target.resolution));
  settings.threads = 1;  // the pairs already run in parallel
  return match_pair(pair.source.mesh, pair.target.mesh, settings).matches;
}

void measure_matches(const Dataset& dataset, const SweptPair& pair, PairMeasures& measures) {
  const CorrespondenceSet matches = matches_of(dataset, pair);
  if (matches.size() == 0) return;
  const std::vector<bool> labels = label_correct(matches, *pair.truth, kCorrectMatch);
  measures.inlier_ratio =
      100 * static_cast<double>(std::count(labels.begin(), labels.end(), true)) / static_cast<double>(labels.size());
  if (const auto share = frame_repeatability(matches, *pair.truth, labels).share())
    measures.frame_repeatability = 100 * *share;
}

}  // namespace

const std::vector<std::string>& measure_names() {
  static const std::vector<std::string> names = {"overlap", "occlusion", "clutter", "inlier_ratio",
                                                 "frame_repeatability"};
  return names;
}

std::optional<double> measure(const PairMeasures& measures, std::size_t place) {
  const std::optional<double> all[] = {measures.overlap, measures.occlusion, measures.clutter, measures.inlier_ratio,
                                       measures.frame_repeatability};
  return all[place];
}

PairMeasures measure_pair(const Dataset& dataset, const SweptPair& pair) {
  PairMeasures measures;
  if (!pair.is_complete() || !pair.truth) return measures;
  const Mesh &source = pair.source.mesh, &target = pair.target.mesh;
  const double near = kOverlapSharePr * pair_resolution(dataset, pair.source.resolution, pair.target.resolution);
  measures.overlap = 100 * overlap_share(source.vertices, target.vertices, *pair.truth, near);
  measures.occlusion = percent_without(shared_area(source, target.vertices, *pair.truth, near));
  measures.clutter = percent_without(shared_area(target, source.vertices, pair.truth->inverse(), near));
  return measures;
}

std::vector<PairMeasures> measure_dataset(const Dataset& dataset, bool with_matches, const ParallelFor& parallel,
                                          Progress& progress) {
  std::vector<PairMeasures> measured(dataset.pairs.size());
  sweep_pairs(dataset, parallel, progress, [&](int i, const SweptPair& pair) {
    PairMeasures& measures = measured[static_cast<std::size_t>(i)];
    measures = measure_pair(dataset, pair);
    const bool can_match = measures.overlap || (pair.truth && !pair.pair.matches.empty());
    if (with_matches && can_match) measure_matches(dataset, pair, measures);
  });
  return measured;
}

std::vector<int> histogram(const std::vector<double>& percent) {
  std::vector<int> counts(10);
  for (const double value : percent)
    ++counts[static_cast<std::size_t>(std::clamp(static_cast<int>(std::floor(value / 10)), 0, 9))];
  return counts;
}

std::string histogram_text(const std::string& name, const std::vector<double>& percent) {
  if (percent.empty()) return "";
  constexpr int kWidth = 50;
  std::vector<double> sorted = percent;
  std::sort(sorted.begin(), sorted.end());
  const std::vector<int> counts = histogram(percent);
  const int most = *std::max_element(counts.begin(), counts.end());
  std::string text = name + ": " + std::to_string(sorted.size()) + " pairs, " + fixed(sorted.front(), 1) + " .. " +
                     fixed(sorted.back(), 1) + " %, median " +
                     fixed((sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2, 1) + " %\n";
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    const std::string low = std::to_string(10 * bin), count = std::to_string(counts[bin]);
    const auto bar = static_cast<std::size_t>(std::ceil(static_cast<double>(kWidth * counts[bin]) / most));
    text += std::string(5 - low.size(), ' ') + low + " %  " +
            std::string(6 - std::min<std::size_t>(count.size(), 6), ' ') + count + "  " + std::string(bar, '#') + "\n";
  }
  return text;
}

}  // namespace corral
