// SPDX-License-Identifier: MIT
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace corral::benchmarks {

using Call = std::function<void()>;
using Setup = std::function<Call()>;  ///< prepares what is not timed; an empty call: there is nothing to do

/// One line of the table: what was timed, by us and by a peer.
struct Row {
  std::vector<std::string> what;    ///< one text per heading, such as mesh, size and stage
  std::string peer;                 ///< which library; empty if no other does this here
  double ours_ms = 0, peer_ms = 0;  ///< median CPU time of the process; 0 where it did not run
};

enum class Side { Ours, Peer };

/// Shows each median on stderr as it comes, and at the end the ratios on stdout: as columns, or as CSV.
class RatioTable : public benchmark::BenchmarkReporter {
 public:
  RatioTable(std::vector<std::string> headings, bool as_csv) : headings_(std::move(headings)), as_csv_(as_csv) {}

  std::size_t add_row(const Row& row);
  /// Registers a benchmark that fills one side of this row. One run of the same name fills all rows that ask for it: ours
  /// stands beside several peers.
  void add_side(const std::string& benchmark, const Setup& setup, std::size_t row, Side side, int repetitions = 5);
  const Row& row(std::size_t index) const { return rows_[index]; }

  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  struct Place {
    std::size_t row;
    Side side;
  };
  std::vector<std::string> headings_;
  bool as_csv_;
  std::vector<Row> rows_;
  std::multimap<std::string, Place> places_;
};

}  // namespace corral::benchmarks
