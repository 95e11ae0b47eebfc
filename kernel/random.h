// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <string>

namespace corral {

/// A reproducible stream of random numbers. The standard fixes the engine but not its distributions, so the draws are our
/// own: the same seed gives the same whole numbers and uniforms with every compiler and library, and the same normals,
/// directions and rotations up to the last bits of its logarithm and cosine.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed);

  /// Uniform in 0 .. count-1 without bias; count must be above 0.
  std::uint64_t below(std::uint64_t count);
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
  std::mt19937_64 engine_;
};

/// The seed of a sub-stream: hashes a name into a seed, so that streams do not depend on the order in which they are drawn.
std::uint64_t derive_seed(std::uint64_t seed, const std::string& name);

}  // namespace corral
