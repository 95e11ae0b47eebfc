// SPDX-License-Identifier: MIT
#include "kernel/surface/matching/nearest_features.h"

#include <algorithm>

#include "kernel/all_finite.h"
#include "kernel/error.h"
#include "kernel/surface/matching/feature_filter.h"

namespace corral {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kTasks = 16;  // at most; each makes its own scratch
constexpr Index kFewTargets = 64;
constexpr double kLittleWork = 1e7;  // numbers, about as many as finding directions takes

void store(NearestFeatures& result, Index query, const TwoNearest& nearest, bool has_second) {
  result.nearest[static_cast<std::size_t>(query)] = nearest.column;
  result.squared_distance(query) = nearest.squared;
  result.second_squared_distance(query) = has_second ? nearest.second_squared : 0;
}

/// Measures everything.
void search_all(const MatrixXd& source, const MatrixXd& target, Index first, Index end, NearestFeatures& result) {
  std::vector<TwoNearest> nearest(static_cast<std::size_t>(end - first));
  offer_all(source, target, first, nearest);
  for (Index query = first; query < end; ++query)
    store(result, query, nearest[static_cast<std::size_t>(query - first)], target.cols() > 1);
}

}  // namespace

void require_finite_features(const Eigen::Ref<const MatrixXd>& features, const std::string& side) {
  if (!all_finite(features.data(), features.size()))
    throw InvalidInput("match_features", side + " features", "not finite", "finite numbers");
}

NearestFeatures find_two_nearest(const MatrixXd& source, const MatrixXd& target, const ParallelFor& parallel) {
  NearestFeatures result;
  if (source.cols() == 0 || target.cols() == 0) return result;
  result.nearest.resize(static_cast<std::size_t>(source.cols()));
  result.squared_distance.resize(source.cols());
  result.second_squared_distance.resize(source.cols());

  constexpr Index kRows = FeatureFilter::kRows;
  const Index each = (source.cols() + kTasks * kRows - 1) / (kTasks * kRows) * kRows;
  const auto for_ranges = [&](const auto& search) {
    parallel(static_cast<int>((source.cols() + each - 1) / each), [&](int task) {
      const Index first = task * each;
      search(first, std::min(source.cols(), first + each));
    });
  };
  const auto measure_all = [&] {
    require_finite_features(source, "source");
    require_finite_features(target, "target");
    for_ranges([&](Index first, Index end) { search_all(source, target, first, end, result); });
  };

  const double work = static_cast<double>(source.cols()) * static_cast<double>(target.cols() * (source.rows() + 64));
  if (target.cols() < kFewTargets || source.rows() == 0 || work < kLittleWork)
    measure_all();
  else if (const FeatureFilter filter(source, target, parallel); !filter.usable())
    measure_all();
  else
    for_ranges([&](Index first, Index end) {
      FilterScratch scratch = filter.scratch();
      for (Index begin = first; begin < end; begin += kRows)
        filter.search(begin, static_cast<int>(std::min(kRows, end - begin)), scratch,
                      [&](Index query, const TwoNearest& nearest) { store(result, query, nearest, true); });
    });
  return result;
}

}  // namespace corral
