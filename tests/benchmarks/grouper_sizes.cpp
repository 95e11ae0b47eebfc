// SPDX-License-Identifier: MIT
// grouper_sizes [--up-to MATCHES] [GROUPER...]: CPU time and peak memory of groupers (default: all) on synthetic tables of 1,000
// to 200,000 matches of which 1, 10, 50 and 90 % are correct. Each table is a process of its own. The time is the least of calls that
// take half a second together; its exponent over the number of matches is that from the table before. The memory is compared
// with what the grouper says that it needs; the exit status is 1 if it takes more. Where that is above 8 GB there is no call.

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
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
constexpr double kMostMb = 8000, kLeast_s = 0.5;

struct Cost {
  double cpu_s = 0, taken_mb = 0;
  std::size_t selected = 0;
};

Cost measure(const ConfiguredGrouper& grouper, const CorrespondenceSet& matches) {
  const auto start = peers::process_cost();
  Cost least;
  for (auto before = start; least.selected == 0 || before.cpu_s - start.cpu_s < kLeast_s;) {
    const std::size_t selected = grouper.group(matches).selected.size();
    const auto after = peers::process_cost();
    const double cpu_s = after.cpu_s - before.cpu_s;
    if (before.cpu_s == start.cpu_s)
      least = {cpu_s, 1.048576 * (after.peak_memory_mb - start.peak_memory_mb), selected};
    least.cpu_s = std::min(least.cpu_s, cpu_s);
    before = after;
    if (selected == 0) break;
  }
  return least;
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

int run(const std::vector<std::string>& names, int most) {
  bool is_honest = true;
  std::printf("%-12s %7s %8s %10s %8s %9s %9s %9s\n", "grouper", "matches", "correct", "cpu_s", "exponent", "peak_mb",
              "stated_mb", "selected");
  for (const std::string& name : names)
    for (const double correct : {0.01, 0.1, 0.5, 0.9}) {
      double last_s = 0, last_matches = 0;
      for (const int matches : {1000, 3000, 10000, 40000, 100000, 200000}) {
        const double stated_mb = find_grouper(name).configure({}).working_memory(matches) / 1e6;
        if (matches > most || stated_mb > kMostMb) break;
        SyntheticOptions options;
        options.matches = matches;
        options.inlier_ratio = correct;
        const Cost cost = measure_apart(name, options);
        const double exponent = last_s == 0 ? 0 : std::log(cost.cpu_s / last_s) / std::log(matches / last_matches);
        last_s = cost.cpu_s, last_matches = matches;
        is_honest &= cost.taken_mb <= stated_mb + kSlackMb;
        std::printf("%-12s %7d %6.0f %% %10.5f %8.2f %9.1f %9.1f %9zu\n", name.c_str(), matches, 100 * correct,
                    cost.cpu_s, exponent, cost.taken_mb, stated_mb, cost.selected);
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
    int most = 200000;
    if (names.size() >= 2 && names[0] == "--up-to") {
      most = std::stoi(names[1]);
      names.erase(names.begin(), names.begin() + 2);
    }
    if (names.empty())
      for (const corral::Grouper& grouper : corral::groupers()) names.push_back(grouper.name);
    return corral::benchmarks::run(names, most);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "grouper_sizes: %s\n", error.what()), 3;
  }
}
