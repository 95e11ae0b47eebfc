// SPDX-License-Identifier: MIT
// pcl_match SOURCE TARGET: PCL's whole match as a process of its own, for its peak memory.

#include <cstdio>
#include <exception>

#include "io/mesh/mesh_file.h"
#include "tests/peers/pcl_surface.h"
#include "tests/peers/process_cost.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: pcl_match SOURCE TARGET\n"), 2;
  try {
    const auto start = corral::peers::process_cost();
    const corral::Mesh source = corral::read_mesh(argv[1]), target = corral::read_mesh(argv[2]);
    const auto before = corral::peers::process_cost();
    corral::peers::PclSurface on_source(source.vertices), on_target(target.vertices);
    const auto match = corral::peers::match_with_pcl(on_source, on_target);
    const auto after = corral::peers::process_cost();
    std::printf("pcl: %zu matches, %.2f s CPU, peak memory %.1f MB (%.1f at the start, %.1f after reading)\n",
                match.nearest.size(), after.cpu_s - before.cpu_s, after.peak_memory_mb, start.peak_memory_mb,
                before.peak_memory_mb);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "pcl_match: %s\n", error.what()), 3;
  }
}
