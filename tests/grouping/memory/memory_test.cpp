// SPDX-License-Identifier: MIT
// What each method says that it needs, against what it takes. The linker sends every malloc and free of the libraries and
// of this program through the counters below.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>
#include <new>

#include "grouping/registry.h"
#include "tests/support/tables.h"

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* block, std::size_t size);
void __real_free(void* block);
}

namespace {

std::size_t held = 0, most_held = 0;

void* taken(void* block) {
  held += block ? ::malloc_usable_size(block) : 0;
  most_held = std::max(most_held, held);
  return block;
}

void* checked(void* block) {
  if (!block) throw std::bad_alloc();
  return taken(block);
}

}  // namespace

extern "C" {
void* __wrap_malloc(std::size_t size) { return taken(__real_malloc(size)); }
void* __wrap_calloc(std::size_t count, std::size_t size) { return taken(__real_calloc(count, size)); }
void* __wrap_realloc(void* block, std::size_t size) {
  held -= block ? ::malloc_usable_size(block) : 0;
  return taken(__real_realloc(block, size));
}
void __wrap_free(void* block) {
  held -= block ? ::malloc_usable_size(block) : 0;
  __real_free(block);
}
}

void* operator new(std::size_t size) { return checked(__real_malloc(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return checked(::aligned_alloc(static_cast<std::size_t>(alignment), (size + 63) / 64 * 64));
}
void operator delete(void* block) noexcept { __wrap_free(block); }
void operator delete(void* block, std::size_t) noexcept { __wrap_free(block); }
void operator delete(void* block, std::align_val_t) noexcept { __wrap_free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { __wrap_free(block); }

namespace corral {
namespace {

struct Case {
  const char* method;
  OptionOverrides options;
};

std::ostream& operator<<(std::ostream& stream, const Case& of) {
  stream << of.method;
  for (const auto& [name, value] : of.options) stream << "_" << value;
  return stream;
}

class WorkingMemory : public ::testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Groupers, WorkingMemory,
                         ::testing::Values(Case{"ss", {}}, Case{"ss", {{"otsu", "bins100"}}}, Case{"nnsr", {}},
                                           Case{"ransac", {{"iterations", "500"}}},
                                           Case{"ransac", {{"iterations", "500"}, {"sampling", "prosac"}}},
                                           Case{"st", {}}, Case{"st", {{"once", "true"}}},
                                           Case{"st", {{"weighted", "true"}}}, Case{"gc", {}},
                                           Case{"gc", {{"cluster", "clique"}}}, Case{"hough", {}},
                                           Case{"hough", {{"cells", "pr5"}}}, Case{"si", {}},
                                           Case{"si", {{"form", "covis"}}}, Case{"turboreg", {}},
                                           Case{"turboreg", {{"keep", "2"}, {"pivots", "100"}}}, Case{"sc2pcr", {}},
                                           Case{"sc2pcr", {{"keep", "2"}}}, Case{"tcf", {}}, Case{"gtm", {}},
                                           Case{"cv", {}}, Case{"frame-ransac", {}}, Case{"clique", {}},
                                           Case{"clique", {{"structure", "core"}}}, Case{"mac", {}}));

TEST_P(WorkingMemory, IsNeverMoreThanStatedAndNotMuchLess) {
  const ConfiguredGrouper grouper = find_grouper(GetParam().method).configure(GetParam().options);
  const std::string method = GetParam().method;
  const bool is_quadratic = method == "st" || method == "turboreg" || method == "sc2pcr" || method == "clique" ||
                            method == "mac" || method == "gtm" || GetParam().options.count("cluster") > 0;
  for (const int rows : {0, 1, 10, 100, 700, is_quadratic ? 1500 : 8000})
    for (const double inlier_ratio : {0.1, 0.9}) {
      const CorrespondenceSet matches = testing::synthetic(rows, inlier_ratio, 1).matches;
      const std::size_t before = held;
      most_held = held;
      const GroupingResult result = grouper.group(matches);
      const double taken_most = static_cast<double>(most_held - before), stated = grouper.working_memory(rows);
      EXPECT_LE(taken_most, stated + 4096) << rows << " rows";  // the rest: blocks are larger than asked for
      if (method == "mac" && inlier_ratio < 0.5) continue;      // its edges are few
      EXPECT_LE(stated, 4 * taken_most + 66000) << rows << " rows";
    }
}

}  // namespace
}  // namespace corral
