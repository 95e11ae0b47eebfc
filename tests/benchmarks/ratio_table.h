// SPDX-License-Identifier: MIT
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace corral::benchmarks {

/// One line of the table: a stage on a mesh, by us and by a peer.
struct Row {
  std::string mesh, stage, peer;  ///< which library
  int vertices = 0;
  double ours_ms = 0, peer_ms = 0;  ///< median CPU time of the process; 0 where it did not run
};

/// Shows each median on stderr as it comes, and at the end the ratios on stdout: as columns, or as CSV.
class RatioTable : public benchmark::BenchmarkReporter {
 public:
  explicit RatioTable(bool as_csv) : as_csv_(as_csv) {}

  std::size_t add_row(const Row& row);
  /// The benchmark of that name fills one side of this row. True if it is the first that asks for it.
  bool expect(const std::string& benchmark, std::size_t row, bool is_ours);

  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  struct Side {
    std::size_t row;
    bool is_ours;
  };
  bool as_csv_;
  std::vector<Row> rows_;
  std::multimap<std::string, Side> sides_;
};

}  // namespace corral::benchmarks
