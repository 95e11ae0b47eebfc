// SPDX-License-Identifier: MIT
// grouper_benchmark [--csv] [--quick] [--benchmark_...] [MESH...]
// CPU time of every grouper on tables of 250 to 10,000 matches (--quick: to 1,000), ours beside other libraries and beside
// plain loops, one thread each: medians of five, and their ratio. Then the arithmetic rates, the growth with n, and whether
// our selections are those of the naive reference; the exit status is 1 if not. With --csv all but the table goes to
// stderr. Without a mesh two of the default data, looked for in build/data or where the environment variable CORRAL_DATA
// says.

#include <benchmark/benchmark.h>

#include <filesystem>
#include <optional>

#include "grouping/registry.h"
#include "tests/benchmarks/grouper_peers.h"
#include "tests/benchmarks/grouper_summary.h"
#include "tests/benchmarks/natural_tables.h"
#include "tests/benchmarks/program.h"
#include "tests/benchmarks/ratio_table.h"

namespace corral::benchmarks {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> default_meshes() {
  std::vector<std::string> paths;
  for (const char* name : {"meshes/bunny00.off", "meshes/refined_elephant.off"}) {
    const fs::path path = fs::path(data_folder(CORRAL_DATA_FOLDER)) / name;
    if (fs::exists(path)) paths.push_back(path.string());
  }
  return paths;
}

std::vector<NaturalTable> read_tables(const std::vector<std::string>& paths, const std::vector<int>& sizes) {
  std::vector<NaturalTable> tables;
  for (Workload& load : read_workloads(paths, ""))
    for (NaturalTable& table : natural_tables(load, sizes)) tables.push_back(std::move(table));
  for (const NaturalTable& table : tables)
    std::fprintf(stderr, "%s n = %d: %.1f %% inliers\n", table.scene.c_str(), table.matches.size(),
                 100 * table.inlier_ratio);
  return tables;
}

/// A table and a grouper, and a row that will hold our time.
struct Case {
  const NaturalTable* table;
  const Grouper* grouper;
  std::size_t row;
};

/// A row with both its sides; without a peer it has ours only.
std::size_t add_row(RatioTable& ratios, const NaturalTable& table, const Grouper& grouper, const GrouperPeer* peer) {
  const std::string count = std::to_string(table.matches.size());
  char inliers[16];
  std::snprintf(inliers, sizeof inliers, "%.3f", table.inlier_ratio);
  const std::size_t row =
      ratios.add_row({{table.scene, count, inliers, grouper.name}, peer ? peer->library : "", 0, 0});

  const bool is_long = grouper.name == "st" && table.matches.size() >= 5000;
  const int repetitions = is_long ? 1 : 5;
  const std::string name = table.scene + "/" + count + "/" + grouper.name + "/";
  const Setup ours = [&table, &grouper]() -> Call {
    const auto use = [group = grouper.configure({}).group](const CorrespondenceSet& matches) {
      benchmark::DoNotOptimize(group(matches));
    };
    if (grouper.name == "ss") return in_turn(table.matches, use);  // as its peer: both are a sort
    return [&table, use] { use(table.matches); };
  };
  ratios.add_side(name + "ours", ours, row, Side::Ours, repetitions);
  const Setup theirs = [&table, peer] { return peer->prepare(table.matches); };
  if (peer) ratios.add_side(name + peer->library, theirs, row, Side::Peer, repetitions);
  return row;
}

/// A row for each peer, or one alone.
Case add_case(RatioTable& ratios, const NaturalTable& table, const Grouper& grouper) {
  std::optional<std::size_t> row;
  for (const GrouperPeer& peer : grouper_peers())
    if (peer.grouper == grouper.name && table.matches.size() <= peer.largest)
      row = add_row(ratios, table, grouper, &peer);
  if (!row) row = add_row(ratios, table, grouper, nullptr);
  return {&table, &grouper, *row};
}

int run(const Arguments& arguments) {
  std::vector<int> sizes{250, 500, 1000, 2000, 5000, 10000};
  std::vector<std::string> paths;
  for (const std::string& word : arguments.words)
    if (word == "--quick")
      sizes = {250, 500, 1000};
    else
      paths.push_back(word);
  if (paths.empty()) paths = default_meshes();
  if (paths.empty()) return no_mesh();
  const std::vector<NaturalTable> tables = read_tables(paths, sizes);
  RatioTable ratios({"scene", "n", "inliers", "grouper"}, arguments.as_csv);
  std::vector<Case> cases;
  for (const Grouper& grouper : groupers())
    for (const NaturalTable& table : tables) cases.push_back(add_case(ratios, table, grouper));
  benchmark::RunSpecifiedBenchmarks(&ratios);

  std::vector<GrouperTime> times;
  for (const Case& each : cases)
    if (const double ms = ratios.row(each.row).ours_ms; ms > 0) times.push_back({each.grouper->name, each.table, ms});
  if (times.empty()) return 0;  // the filter asked for peers only
  std::FILE* const to = arguments.as_csv ? stderr : stdout;
  print_rates(to, times);
  print_exponents(to, times);
  return print_labels(to, times) ? 0 : 1;
}

}  // namespace
}  // namespace corral::benchmarks

int main(int argc, char** argv) {
  return corral::benchmarks::run_program("grouper_benchmark", argc, argv, corral::benchmarks::run);
}
