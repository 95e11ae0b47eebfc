// SPDX-License-Identifier: MIT
#include "kernel/surface/matching/feature_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/surface/matching/feature_scores.h"
#include "kernel/surface/matching/projection_loops.h"

namespace corral {
namespace {

constexpr int kSmallSample = 252, kLargeSample = 504;  // features, multiples of kRowTile
constexpr int kManyFeatures = 4000;
constexpr int kRounds = 2;  // of power iteration
constexpr int kFineDirections = kFineNumbers - 2, kCoarseDirections = kCoarseNumbers - 2;
constexpr int kChunk = 32;  // products that floats add up before they are added to the rest
constexpr int kExponents = 400;
constexpr double kUnit = 0x1p-24;   // of float
constexpr double kTiny = 1e-30;     // what underflow in floats may add to lengths near 1
constexpr double kFarthest = 1e15;  // lengths whose squares floats still hold

static_assert(kFineNumbers == kPanelColumns && kSmallSample % kRowTile + kLargeSample % kRowTile == 0);

std::size_t size_of(int count, int each) { return static_cast<std::size_t>(count) * static_cast<std::size_t>(each); }

int padded_to_tile(int rows) { return (rows + kRowTile - 1) / kRowTile * kRowTile; }

/// Columns of both sides in turns, evenly spread.
Eigen::MatrixXd sample_of(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target) {
  const Eigen::Index size = source.cols() + target.cols() < kManyFeatures ? kSmallSample : kLargeSample;
  const Eigen::Index sources = std::min(source.cols(), size / 2), targets = std::min(target.cols(), size / 2);
  Eigen::MatrixXd sample(source.rows(), sources + targets);
  Eigen::Index column = 0;
  for (Eigen::Index i = 0; i < std::max(sources, targets); ++i) {
    if (i < sources) sample.col(column++) = source.col(i * source.cols() / sources);
    if (i < targets) sample.col(column++) = target.col(i * target.cols() / targets);
  }
  return sample;
}

}  // namespace

ProjectedFeatures::ProjectedFeatures(Eigen::Index dimension, int rows) {
  const int count = padded_to_tile(rows);
  numbers.resize(size_of(count, static_cast<int>(dimension)));
  coarse.resize(size_of(count, kCoarseNumbers));
  fine.resize(size_of(count, kFineNumbers));
  for (std::vector<double>* each : {&coarse_squared, &fine_squared, &error}) each->resize(size_of(count, 1));
}

FeatureProjection::FeatureProjection(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target)
    : dimension_(source.rows()) {
  const Eigen::MatrixXd sample = sample_of(source, target);
  choose_scale(sample);
  if (usable_) find_directions(sample);
}

void FeatureProjection::choose_scale(const Eigen::MatrixXd& sample) {
  const double largest = sample.cwiseAbs().maxCoeff();
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  usable_ = std::abs(exponent) <= kExponents;
  scale_ = std::ldexp(1.0, usable_ ? -exponent : 0);
  if (usable_) center_ = sample.rowwise().mean();
}

void FeatureProjection::find_directions(const Eigen::MatrixXd& sample) {
  const auto length = static_cast<int>(dimension_), count = static_cast<int>(sample.cols());
  const int rows = padded_to_tile(length), columns = padded_to_tile(count);
  FloatColumn numbers(size_of(columns, length)), turned(size_of(rows, columns)),
      weights(size_of(columns, kPanelColumns)), sums(size_of(rows, kPanelColumns));
  std::vector<double> squared(size_of(columns, 1));
  round_features(sample, 0, count, numbers.data(), squared.data());
  for (int row = 0; row < length; ++row)
    for (int i = 0; i < count; ++i) turned[row * columns + i] = numbers[i * length + row];

  // From features X to X X^T times them, orthonormalised, and again.
  panel_.assign(size_of(length, kPanelColumns), 0);
  for (int row = 0; row < length; ++row)
    for (int k = 0; k < kFineDirections; ++k)
      panel_[row * kPanelColumns + k] = turned[row * columns + k * count / kFineDirections];
  AlignedColumn directions(size_of(kFineDirections, padded(length)));
  for (int round = 1; round <= kRounds; ++round) {
    std::fill(weights.begin(), weights.end(), 0.F);
    std::fill(sums.begin(), sums.end(), 0.F);
    add_products(panel_.data(), length, {numbers.data(), length, columns}, weights.data());
    add_products(weights.data(), columns, {turned.data(), columns, rows}, sums.data());
    for (int k = 0; k < kFineDirections; ++k)
      for (int row = 0; row < length; ++row) directions[k * padded(length) + row] = sums[row * kPanelColumns + k];
    orthonormalise({directions.data(), padded(length), kFineDirections});
    round_directions(directions);
  }
  measure_directions(directions);
}

void FeatureProjection::round_directions(AlignedColumn& directions) {
  const auto length = static_cast<int>(dimension_);
  for (int row = 0; row < length; ++row)
    for (int k = 0; k < kFineDirections; ++k) {
      const auto number = static_cast<float>(directions[k * padded(length) + row]);
      panel_[row * kPanelColumns + k] = number;
      directions[k * padded(length) + row] = number;
    }
}

// Let Q be the directions in floats, u half the last place of 1, and R = (Q^T Q)^(1/2). Then Q R^-1 is orthonormal, of
// the same span, and |R - I| is at most the defect |Q^T Q - I|, so that Q^T x is within |x| defect of an exact projection.
// Rounding x moves it by u |x|; adding up in floats, chunk by chunk, changes each of the K products by as many u |x| as
// a chunk has products and there are chunks.
void FeatureProjection::measure_directions(const AlignedColumn& directions) {
  const auto length = static_cast<int>(dimension_);
  const double defect = orthonormality_defect({directions.data(), padded(length), kFineDirections}) + 1e-12;
  const double terms = std::min(length, kChunk) + (length + kChunk - 1) / kChunk + 2;
  relative_error_ = 1.05 * (defect + kUnit + std::sqrt(kFineDirections) * terms * kUnit);
  usable_ = relative_error_ < 0.01;
}

void FeatureProjection::round_features(const Eigen::MatrixXd& features, Eigen::Index first, int count, float* numbers,
                                       double* squared) const {
  const auto length = static_cast<int>(dimension_);
  scale_and_round({features.data() + first * length, length, count}, center_.data(), scale_, numbers, squared);
}

void FeatureProjection::project(const Eigen::MatrixXd& features, Eigen::Index first, int count,
                                ProjectedFeatures& out) const {
  const auto length = static_cast<int>(dimension_);
  round_features(features, first, count, out.numbers.data(), out.error.data());
  const int rows = padded_to_tile(count);
  std::fill_n(out.fine.begin(), rows * kFineNumbers, 0.F);
  for (int row = 0; row < length; row += kChunk)
    add_products(panel_.data() + row * kPanelColumns, std::min(kChunk, length - row),
                 {out.numbers.data() + row, length, rows}, out.fine.data());
  for (int row = 0; row < count; ++row) finish_row(out.error[row], row, out);
}

// The length of the rest is that of the missing side of a right-angled triangle. If |Q^T x| is off by e, its square is off
// by at most w = e (2 |x| + e), and so is that of the rest r; r itself is off by at most min(sqrt(w), w / r).
void FeatureProjection::finish_row(double squared, int row, ProjectedFeatures& out) const {
  const double length = std::sqrt(squared), off = relative_error_ * length + kTiny;
  const double square_off = off * (2 * length + off) + (static_cast<double>(dimension_) + 64) * 0x1p-52 * squared;
  float* fine = out.fine.data() + row * kFineNumbers;
  float* coarse = out.coarse.data() + row * kCoarseNumbers;
  std::copy_n(fine, kCoarseDirections, coarse);
  out.error[row] = 0;
  const auto finish = [&](float* numbers, int directions) {
    const double kept = Eigen::Map<const Eigen::ArrayXf>(numbers, directions).cast<double>().square().sum();
    const double rest = std::sqrt(std::max(0.0, squared - kept));
    const double rest_off = std::min(std::sqrt(square_off), rest > 0 ? square_off / rest : length + off);
    numbers[directions] = static_cast<float>(rest);
    numbers[directions + 1] = 1;
    const double error = off + rest_off + (kUnit + 0x1p-52) * (length + off);
    out.error[row] = std::max(out.error[row], 1.01 * error);
    return kept + static_cast<double>(numbers[directions]) * numbers[directions];
  };
  out.coarse_squared[row] = finish(coarse, kCoarseDirections);
  out.fine_squared[row] = finish(fine, kFineDirections);
  if (!(length < kFarthest)) out.error[row] = std::numeric_limits<double>::infinity();
}

}  // namespace corral
