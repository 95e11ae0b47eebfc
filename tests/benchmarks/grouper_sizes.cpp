// SPDX-License-Identifier: MIT
// grouper_sizes [GROUPER...]: CPU time and peak memory of groupers (default: all) on synthetic tables of 10,000 to 200,000
// matches of which 1, 10 and 50 % are correct. Each call is a process of its own. The time is compared with that of the
// smallest table, the memory with what the grouper says that it needs; the exit status is 1 if it takes more.

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "grouping/registry.h"
#include "kernel/error.h"
#include "kernel/synthetic.h"
#include "tests/peers/process_cost.h"

namespace corral::benchmarks {
namespace {

constexpr double kSlackMb = 4;  // what the allocator and the loader take

struct Cost {
  double cpu_s = 0, taken_mb = 0;
  std::size_t selected = 0;
};

Cost measure(const ConfiguredGrouper& grouper, const CorrespondenceSet& matches) {
  const auto before = peers::process_cost();
  const std::size_t selected = grouper.group(matches).selected.size();
  const auto after = peers::process_cost();
  return {after.cpu_s - before.cpu_s, 1.048576 * (after.peak_memory_mb - before.peak_memory_mb), selected};
}

/// The same in a child, whose peak memory is not that of earlier calls.
Cost measure_apart(const std::string& name, const SyntheticOptions& options) {
  int ends[2];
  if (::pipe(ends) != 0) throw IoError("pipe", "", "cannot be made");
  const pid_t child = ::fork();
  if (child == 0) {
    const Cost cost = measure(find_grouper(name).configure({}), make_synthetic_problem(options).matches);
    ::_exit(::write(ends[1], &cost, sizeof cost) == sizeof cost ? 0 : 1);
  }
  ::close(ends[1]);
  Cost cost;
  const bool is_whole = child > 0 && ::read(ends[0], &cost, sizeof cost) == sizeof cost;
  ::close(ends[0]);
  if (child > 0) ::waitpid(child, nullptr, 0);
  if (!is_whole) throw IoError(name, "", "did not end");
  return cost;
}

int run(const std::vector<std::string>& names) {
  bool is_honest = true;
  std::printf("%-7s %7s %8s %9s %8s %9s %9s %9s\n", "grouper", "matches", "correct", "cpu_s", "growth", "peak_mb",
              "stated_mb", "selected");
  for (const std::string& name : names)
    for (const double correct : {0.01, 0.1, 0.5}) {
      double smallest_s = 0;
      for (const int matches : {10000, 40000, 100000, 200000}) {
        SyntheticOptions options;
        options.matches = matches;
        options.inlier_ratio = correct;
        const Cost cost = measure_apart(name, options);
        if (smallest_s == 0) smallest_s = cost.cpu_s;
        const double stated_mb = find_grouper(name).configure({}).working_memory(matches) / 1e6;
        is_honest &= cost.taken_mb <= stated_mb + kSlackMb;
        std::printf("%-7s %7d %6.0f %% %9.3f %8.1f %9.1f %9.1f %9zu\n", name.c_str(), matches, 100 * correct,
                    cost.cpu_s, cost.cpu_s / smallest_s, cost.taken_mb, stated_mb, cost.selected);
        std::fflush(stdout);
      }
    }
  return is_honest ? 0 : 1;
}

}  // namespace
}  // namespace corral::benchmarks

int main(int argc, char** argv) {
  try {
    std::vector<std::string> names(argv + 1, argv + argc);
    if (names.empty())
      for (const corral::Grouper& grouper : corral::groupers()) names.push_back(grouper.name);
    return corral::benchmarks::run(names);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "grouper_sizes: %s\n", error.what()), 3;
  }
}
