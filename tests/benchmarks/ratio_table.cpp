// SPDX-License-Identifier: MIT
#include "tests/benchmarks/ratio_table.h"

#include <cstdio>
#include <iostream>

namespace corral::benchmarks {
namespace {

std::string number(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A time, or a dash where nothing ran.
std::string time_text(double ms) { return ms > 0 ? number("%.1f", ms) : "-"; }

}  // namespace

std::size_t RatioTable::add_row(const Row& row) {
  rows_.push_back(row);
  return rows_.size() - 1;
}

bool RatioTable::expect(const std::string& benchmark, std::size_t row, bool is_ours) {
  const bool is_first = sides_.count(benchmark) == 0;
  sides_.insert({benchmark, {row, is_ours}});
  return is_first;
}

bool RatioTable::ReportContext(const Context& context) {
  PrintBasicContext(&std::cerr, context);
  return true;
}

void RatioTable::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    const bool is_median = run.run_type == Run::RT_Aggregate ? run.aggregate_name == "median" : run.repetitions <= 1;
    if (!is_median || run.error_occurred) continue;
    std::cerr << run.run_name.function_name << ": " << time_text(run.GetAdjustedCPUTime()) << " ms\n";
    const auto [begin, end] = sides_.equal_range(run.run_name.function_name);
    for (auto side = begin; side != end; ++side) {
      Row& row = rows_[side->second.row];
      (side->second.is_ours ? row.ours_ms : row.peer_ms) = run.GetAdjustedCPUTime();
    }
  }
}

void RatioTable::Finalize() {
  const char* columns = as_csv_ ? "%s,%s,%s,%s,%s,%s,%s\n" : "%-22s %8s  %-14s %10s %10s %7s  %s\n";
  std::printf(columns, "mesh", "vertices", "stage", "ours_ms", "peer_ms", "ratio", "peer");
  for (const Row& row : rows_) {
    if (!(row.ours_ms > 0) && !(row.peer_ms > 0)) continue;
    const bool both = row.ours_ms > 0 && row.peer_ms > 0;
    std::printf(columns, row.mesh.c_str(), std::to_string(row.vertices).c_str(), row.stage.c_str(),
                time_text(row.ours_ms).c_str(), time_text(row.peer_ms).c_str(),
                both ? number("%.2f", row.ours_ms / row.peer_ms).c_str() : "-", row.peer.c_str());
  }
}

}  // namespace corral::benchmarks
