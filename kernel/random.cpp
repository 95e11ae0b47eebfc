// SPDX-License-Identifier: MIT
#include "kernel/random.h"

#include <Eigen/Geometry>
#include <cmath>

namespace corral {
namespace {

/// The finaliser of SplitMix64: a bijection of 64-bit words in which every input bit changes half of the output.
std::uint64_t mix(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15u;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9u;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebu;
  return word ^ (word >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed) : engine_(mix(seed)) {}

std::uint64_t RandomStream::below(std::uint64_t count) {
  std::uint64_t word = engine_();
  if (word < count) {  // only then can the word be one of the first 2^64 mod count, which would favour small values
    const std::uint64_t rejected = (0 - count) % count;
    while (word < rejected) word = engine_();
  }
  return word % count;
}

double RandomStream::uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

double RandomStream::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(6.283185307179586 * uniform());
}

Eigen::Vector3d RandomStream::direction() {
  Eigen::Vector3d sample;
  do {
    const double x = normal(), y = normal(), z = normal();  // named: the order of arguments is not fixed
    sample = Eigen::Vector3d(x, y, z);
  } while (!(sample.norm() > 1e-6));
  return sample.normalized();
}

Eigen::Matrix3d RandomStream::rotation() {
  Eigen::Vector4d sample;
  do {
    for (int i = 0; i < 4; ++i) sample(i) = normal();
  } while (!(sample.norm() > 1e-6));
  sample.normalize();
  return Eigen::Quaterniond(sample(0), sample(1), sample(2), sample(3)).toRotationMatrix();
}

std::uint64_t derive_seed(std::uint64_t seed, const std::string& name) {
  std::uint64_t state = mix(seed);
  for (const char letter : name) state = mix(state ^ static_cast<unsigned char>(letter));
  return mix(state ^ name.size());
}

}  // namespace corral
