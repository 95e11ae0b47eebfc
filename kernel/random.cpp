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

/// The next word of the state after `first`, from the one that follows it and one that lies farther.
std::uint64_t twisted(std::uint64_t first, std::uint64_t second, std::uint64_t far) {
  const std::uint64_t joined = (first & 0xFFFFFFFF80000000u) | (second & 0x7FFFFFFFu);
  return far ^ (joined >> 1) ^ ((0 - (joined & 1)) & 0xB5026F5AA96619E9u);
}

std::uint64_t tempered(std::uint64_t word) {
  word ^= (word >> 29) & 0x5555555555555555u;
  word ^= (word << 17) & 0x71D67FFFEDA60000u;
  word ^= (word << 37) & 0xFFF7EEE000000000u;
  return word ^ (word >> 43);
}

}  // namespace

MersenneTwister::MersenneTwister(std::uint64_t seed) {
  state_[0] = seed;
  for (std::size_t i = 1; i < kWords; ++i)
    state_[i] = 6364136223846793005u * (state_[i - 1] ^ (state_[i - 1] >> 62)) + i;
}

void MersenneTwister::refill() {
  constexpr std::size_t kFar = kWords / 2;
  for (std::size_t i = 0; i < kFar; ++i) state_[i] = twisted(state_[i], state_[i + 1], state_[i + kFar]);
  for (std::size_t i = kFar; i + 1 < kWords; ++i) state_[i] = twisted(state_[i], state_[i + 1], state_[i - kFar]);
  state_[kWords - 1] = twisted(state_[kWords - 1], state_[0], state_[kFar - 1]);
  for (std::size_t i = 0; i < kWords; ++i) words_[i] = tempered(state_[i]);
  used_ = 0;
}

RandomStream::RandomStream(std::uint64_t seed) : engine_(mix(seed)) {}

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
