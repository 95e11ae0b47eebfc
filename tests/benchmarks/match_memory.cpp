// SPDX-License-Identifier: MIT
// match_memory SOURCE TARGET: our whole match as a process of its own, for its peak memory. Beside tests/peers/pcl_match.

#include <cstdio>
#include <exception>

#include "io/mesh/mesh_file.h"
#include "tests/benchmarks/our_stages.h"
#include "tests/peers/process_cost.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: match_memory SOURCE TARGET\n"), 2;
  try {
    const auto start = corral::peers::process_cost();
    const corral::Mesh source = corral::read_mesh(argv[1]), target = corral::read_mesh(argv[2]);
    const auto before = corral::peers::process_cost();
    const auto pair = corral::ours::whole_match(source, target);
    const auto after = corral::peers::process_cost();
    std::printf("ours: %d matches, %.2f s CPU, peak memory %.1f MB (%.1f at the start, %.1f after reading)\n",
                pair.matches.size(), after.cpu_s - before.cpu_s, after.peak_memory_mb, start.peak_memory_mb,
                before.peak_memory_mb);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "match_memory: %s\n", error.what()), 3;
  }
}
