// SPDX-License-Identifier: MIT
#include "apps/results/bootstrap.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "apps/results/statistics.h"
#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {
namespace {

/// Where BCa reads the sorted resamples instead of at the level whose normal quantile is z.
double bca_level(double z, double bias, double acceleration) {
  const double shifted = bias + z, denominator = 1 - acceleration * shifted;
  if (!(denominator > 0)) return z < 0 ? 0 : 1;
  return boost::math::cdf(boost::math::normal(), bias + shifted / denominator);
}

/// The count, the mean, and the sums of squares and cubes of what is off the mean.
struct Moments {
  double count = 0, mean = 0, squares = 0, cubes = 0;
};

Moments moments_of(const std::vector<double>& values) {
  Moments of;
  of.count = static_cast<double>(values.size());
  of.mean = std::accumulate(values.begin(), values.end(), 0.0) / of.count;
  for (const double value : values) {
    const double off = value - of.mean;
    of.squares += off * off;
    of.cubes += off * off * off;
  }
  if (values.size() == 1 || !(of.squares > 0)) of.squares = 0;
  return of;
}

/// The means of the resamples, of each column. The columns lie beside each other, so that a draw reads them at once.
std::vector<std::vector<double>> resampled_means(const std::vector<std::vector<double>>& columns, std::uint64_t seed) {
  constexpr std::size_t kLanes = 4;
  const std::size_t n = columns.front().size();
  std::vector<std::vector<double>> means(columns.size(), std::vector<double>(kResamples));
  for (std::size_t first = 0; first < columns.size(); first += kLanes) {
    const std::size_t lanes = std::min(kLanes, columns.size() - first);
    std::vector<std::array<double, kLanes>> rows(n);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      for (std::size_t row = 0; row < n; ++row) rows[row][lane] = columns[first + lane][row];
    RandomStream stream(seed);
    for (std::size_t resample = 0; resample < kResamples; ++resample) {
      std::array<double, kLanes> sums{};
      for (std::size_t i = 0; i < n; ++i) {
        const std::array<double, kLanes>& row = rows[stream.below(n)];
        for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += row[lane];
      }
      for (std::size_t lane = 0; lane < lanes; ++lane)
        means[first + lane][resample] = sums[lane] / static_cast<double>(n);
    }
  }
  return means;
}

/// BCa at Student's quantiles, from the means of the resamples.
MeanInterval bca_interval(const Moments& of, std::vector<double> means) {
  std::sort(means.begin(), means.end());
  const auto below = std::lower_bound(means.begin(), means.end(), of.mean) - means.begin();
  const auto not_above = std::upper_bound(means.begin(), means.end(), of.mean) - means.begin();
  const double share = static_cast<double>(below + not_above) / 2 / kResamples;
  const double bias =
      boost::math::quantile(boost::math::normal(), std::clamp(share, 1.0 / kResamples, 1 - 1.0 / kResamples));
  const double acceleration = of.cubes / (6 * std::pow(of.squares, 1.5));
  const double z = boost::math::quantile(boost::math::students_t(of.count - 1), 0.975);
  return {of.mean, quantile_of(means, bca_level(-z, bias, acceleration)),
          quantile_of(means, bca_level(z, bias, acceleration))};
}

}  // namespace

MeanInterval bootstrap_mean(const std::vector<double>& values, std::uint64_t seed) {
  return bootstrap_means({values}, seed).front();
}

std::vector<MeanInterval> bootstrap_means(const std::vector<std::vector<double>>& columns, std::uint64_t seed) {
  std::vector<Moments> moments;
  for (const std::vector<double>& column : columns) {
    if (column.empty()) throw InvalidInput("bootstrap_mean", "values", "none", "one or more");
    if (column.size() != columns.front().size())
      throw InvalidInput("bootstrap_mean", "columns", std::to_string(column.size()) + " values", "as many in each");
    moments.push_back(moments_of(column));
  }
  std::vector<MeanInterval> intervals;
  const auto varies = [](const Moments& of) { return of.squares > 0; };
  if (std::none_of(moments.begin(), moments.end(), varies)) {
    for (const Moments& of : moments) intervals.push_back({of.mean, of.mean, of.mean});
    return intervals;
  }
  std::vector<std::vector<double>> means = resampled_means(columns, seed);
  for (std::size_t i = 0; i < columns.size(); ++i)
    intervals.push_back(varies(moments[i]) ? bca_interval(moments[i], std::move(means[i]))
                                           : MeanInterval{moments[i].mean, moments[i].mean, moments[i].mean});
  return intervals;
}

}  // namespace corral
