// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>

namespace corral {

/// The engine std::mt19937_64, word for word, without a branch for each: a third of its time.
class MersenneTwister {
 public:
  explicit MersenneTwister(std::uint64_t seed);

  std::uint64_t operator()() {
    if (used_ == kWords) refill();
    return words_[used_++];
  }

 private:
  static constexpr std::size_t kWords = 312;
  void refill();

  std::uint64_t state_[kWords], words_[kWords];
  std::size_t used_ = kWords;
};

/// The numbers 0 .. count-1; made once for many draws, whose remainders then take no division.
class WholeRange {
 public:
  explicit WholeRange(std::uint64_t count) : count_(count), reciprocal_(~std::uint64_t{0} / count) {}
  std::uint64_t count() const { return count_; }

  /// word mod count. With r = floor((2^64 - 1) / count), floor(word r / 2^64) is the quotient or one less.
  std::uint64_t remainder(std::uint64_t word) const {
    const auto quotient = static_cast<std::uint64_t>(Wide{word} * reciprocal_ >> 64);
    const std::uint64_t rest = word - quotient * count_;
    return rest < count_ ? rest : rest - count_;
  }

 private:
  __extension__ using Wide = unsigned __int128;
  std::uint64_t count_, reciprocal_;
};

/// A reproducible stream of random numbers. The standard fixes the engine but not its distributions, so the draws are our
/// own: the same seed gives the same whole numbers and uniforms with every compiler and library, and the same normals,
/// directions and rotations up to the last bits of its logarithm and cosine.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed);

  /// Uniform in 0 .. count-1 without bias; count must be above 0.
  std::uint64_t below(const WholeRange& range) {
    std::uint64_t word = engine_();
    if (word < range.count()) {  // only then can it be one of the first 2^64 mod count, which would favour small values
      const std::uint64_t rejected = (0 - range.count()) % range.count();
      while (word < rejected) word = engine_();
    }
    return range.remainder(word);
  }
  std::uint64_t below(std::uint64_t count) { return below(WholeRange(count)); }
  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Normal with mean 0 and deviation 1 (Box and Muller's transform).
  double normal();
  /// Uniform over the unit sphere.
  Eigen::Vector3d direction();
  /// Uniform over all rotations.
  Eigen::Matrix3d rotation();

 private:
  MersenneTwister engine_;
};

/// The seed of a sub-stream: hashes a name into a seed, so that streams do not depend on the order in which they are drawn.
std::uint64_t derive_seed(std::uint64_t seed, const std::string& name);

}  // namespace corral
