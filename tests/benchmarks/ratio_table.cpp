// SPDX-License-Identifier: MIT
#include "tests/benchmarks/ratio_table.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

namespace corral::benchmarks {
namespace {

using Line = std::vector<std::string>;

std::string number(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A time, or a dash where nothing ran.
std::string time_text(double ms) {
  if (!(ms > 0)) return "-";
  return number(ms < 1 ? "%.4f" : ms < 100 ? "%.2f" : "%.1f", ms);
}

Line line_of(const Row& row) {
  Line line = row.what;
  const bool both = row.ours_ms > 0 && row.peer_ms > 0;
  for (const std::string& text : {time_text(row.ours_ms), time_text(row.peer_ms),
                                  both ? number("%.3g", row.ours_ms / row.peer_ms) : std::string("-"), row.peer})
    line.push_back(text);
  return line;
}

void print_csv(const std::vector<Line>& lines) {
  for (const Line& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i)
      std::printf("%s%s", line[i].c_str(), i + 1 < line.size() ? "," : "\n");
}

/// The first columns to the left, those of numbers to the right.
void print_columns(const std::vector<Line>& lines, std::size_t left_columns) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const Line& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  for (const Line& line : lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      std::printf(i < left_columns ? "%-*s  " : "%*s  ", static_cast<int>(widths[i]), line[i].c_str());
    std::printf("%s\n", line.back().c_str());
  }
}

}  // namespace

std::size_t RatioTable::add_row(const Row& row) {
  rows_.push_back(row);
  return rows_.size() - 1;
}

void RatioTable::add_side(const std::string& name, const Setup& setup, std::size_t row, Side side, int repetitions) {
  const bool is_first = places_.count(name) == 0;
  places_.insert({name, {row, side}});
  if (!is_first) return;
  const auto run = [setup](benchmark::State& state) {
    const Call call = setup();
    if (!call) return state.SkipWithError("nothing to do");
    for (auto _ : state) call();
  };
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->MinTime(0.05)
      ->Repetitions(repetitions)
      ->ReportAggregatesOnly();
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
    const auto [begin, end] = places_.equal_range(run.run_name.function_name);
    for (auto place = begin; place != end; ++place) {
      Row& row = rows_[place->second.row];
      (place->second.side == Side::Ours ? row.ours_ms : row.peer_ms) = run.GetAdjustedCPUTime();
    }
  }
}

void RatioTable::Finalize() {
  std::vector<Line> lines{headings_};
  for (const char* heading : {"ours_ms", "peer_ms", "ratio", "peer"}) lines.front().push_back(heading);
  for (const Row& row : rows_)
    if (row.ours_ms > 0 || row.peer_ms > 0) lines.push_back(line_of(row));
  as_csv_ ? print_csv(lines) : print_columns(lines, headings_.size());
}

}  // namespace corral::benchmarks
