// SPDX-License-Identifier: MIT
#include "grouping/compatibility.h"

#include <algorithm>
#include <limits>

#include "kernel/vectorized.h"

namespace corral {

std::vector<double> feature_ratios(const CorrespondenceSet& matches) {
  const double *const d1 = matches.feature_distance.data(), *const d2 = matches.second_feature_distance.data();
  const auto count = static_cast<std::size_t>(matches.size()), whole = count - count % kLanes;
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> ratios(count);
  vectorized([&](auto kind) {
    using Lanes = typename decltype(kind)::Lanes;
    for (std::size_t row = 0; row < whole; row += kLanes) {
      const Lanes second = Lanes::load(d2 + row);
      select(Lanes::fill(0) < second, Lanes::load(d1 + row) / second, Lanes::fill(kAbsent)).store(&ratios[row]);
    }
  });
  for (std::size_t row = whole; row < count; ++row) ratios[row] = d2[row] > 0 ? d1[row] / d2[row] : kAbsent;
  return ratios;
}

std::vector<double> ratio_scores(const std::vector<double>& ratios) {
  std::vector<double> scores(ratios.size());
  std::transform(ratios.begin(), ratios.end(), scores.begin(), [](double ratio) {
    return ratio == ratio ? std::max(1 - ratio, std::numeric_limits<double>::lowest()) : 0;
  });
  return scores;
}

Indices marked_rows(const std::vector<std::uint8_t>& marks) {
  Indices rows(marks.size());
  std::size_t count = 0;
  for (std::size_t row = 0; row < marks.size(); ++row) {  // without a branch, which no predictor would foresee
    rows[count] = static_cast<int>(row);
    count += marks[row];
  }
  rows.resize(count);
  return rows;
}

RigidTransform transform_from_frames(const CorrespondenceSet& matches, int row) {
  const auto i = static_cast<std::size_t>(row);
  RigidTransform target_from_source;
  target_from_source.rotation = matches.target_frames[i].transpose() * matches.source_frames[i];
  target_from_source.translation = matches.target_points.row(row).transpose() -
                                   target_from_source.rotation * matches.source_points.row(row).transpose();
  return target_from_source;
}

}  // namespace corral
