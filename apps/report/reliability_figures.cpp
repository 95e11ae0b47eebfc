// SPDX-License-Identifier: MIT
#include "apps/report/reliability_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "apps/pair/confidence.h"
#include "apps/results/measures.h"
#include "apps/results/statistics.h"
#include "apps/runtime/text_table.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr int kTenths = 10;

Reliability reliability_of(const RatedPoses& method) {
  std::vector<JudgedPose> judged;
  for (const bool right : method.right) judged.push_back({{}, right, ""});
  return reliability(method.probabilities, judged);
}

}  // namespace

RatedPoses rated_poses(const std::string& method, const std::vector<const StudyRecord*>& records) {
  static const Measure& success = measure("success_5pr");
  RatedPoses rated{method, {}, {}};
  for (const StudyRecord* record : records) {
    const std::optional<double> right = success.of(*record);
    if (!record->confidence || !right) continue;
    rated.probabilities.push_back(*record->confidence);
    rated.right.push_back(*right > 0);
  }
  return rated;
}

void draw_reliability(const std::vector<RatedPoses>& methods, Panel& panel) {
  panel.axes = PanelAxes::Curve;
  panel.x_axis = "probability without the truth";
  panel.y_axis = "share of right poses";
  panel.levels.clear();
  for (int tenth = 0; tenth < kTenths; ++tenth) panel.levels.push_back(to_text((tenth + 0.5) / kTenths));
  PanelCount brier{"Brier", {}}, area{"area", {}}, error{"calibration error", {}}, poses{"poses", {}};
  for (const RatedPoses& method : methods) {
    if (method.right.empty()) continue;
    PanelSeries series{method.method, {}};
    for (int tenth = 0; tenth < kTenths; ++tenth) {
      int all = 0, right = 0;
      for (std::size_t i = 0; i < method.right.size(); ++i) {
        if (std::min(static_cast<int>(method.probabilities[i] * kTenths), kTenths - 1) != tenth) continue;
        ++all, right += method.right[i];
      }
      if (all == 0) {
        series.values.push_back({});
        continue;
      }
      const auto [low, high] = wilson_interval(right, all);
      series.values.push_back({static_cast<double>(right) / all, low, high});
    }
    panel.series.push_back(series);
    const Reliability found = reliability_of(method);
    brier.cells.push_back(fixed(found.brier, 3));
    area.cells.push_back(fixed(found.area, 3));
    error.cells.push_back(fixed(found.calibration_error, 3));
    poses.cells.push_back(std::to_string(found.pairs));
  }
  panel.series_counts = {poses, brier, area, error};
}

void draw_coverage(const std::vector<RatedPoses>& methods, Panel& panel) {
  panel.axes = PanelAxes::Curve;
  panel.x_axis = "share of poses kept, the most probable first";
  panel.y_axis = "share of right poses";
  panel.levels.clear();
  for (int tenth = 1; tenth <= kTenths; ++tenth) panel.levels.push_back(to_text(static_cast<double>(tenth) / kTenths));
  for (const RatedPoses& method : methods) {
    if (method.right.empty()) continue;
    std::vector<std::size_t> order(method.right.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return method.probabilities[a] > method.probabilities[b]; });
    PanelSeries series{method.method, {}};
    for (int tenth = 1; tenth <= kTenths; ++tenth) {
      const auto kept =
          static_cast<std::ptrdiff_t>((order.size() * static_cast<std::size_t>(tenth) + kTenths - 1) / kTenths);
      const auto right =
          std::count_if(order.begin(), order.begin() + kept, [&](std::size_t i) { return method.right[i]; });
      series.values.push_back({static_cast<double>(right) / static_cast<double>(kept), {}, {}});
    }
    panel.series.push_back(series);
  }
}

}  // namespace corral
