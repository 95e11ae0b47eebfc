// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace corral {

/// Numbers that hot loops work on together (lanes-inl.h): columns that they read are padded to a multiple of them.
constexpr int kLanes = 8, kFloatLanes = 16;

constexpr int padded(int count, int lanes = kLanes) { return (count + lanes - 1) / lanes * lanes; }

/// Starts every column at a cache line, so that no load of whole lanes straddles two.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class Other>
  CacheLineAllocator(const CacheLineAllocator<Other>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* from, std::size_t) { ::operator delete (from, std::align_val_t{64}); }
  friend bool operator==(CacheLineAllocator, CacheLineAllocator) { return true; }
  friend bool operator!=(CacheLineAllocator, CacheLineAllocator) { return false; }
};
using AlignedColumn = std::vector<double, CacheLineAllocator<double>>;
using FloatColumn = std::vector<float, CacheLineAllocator<float>>;

}  // namespace corral
