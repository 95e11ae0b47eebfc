// SPDX-License-Identifier: MIT
#include "apps/results/study_results.h"

#include "apps/results/statistics.h"
#include "io/text/csv_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

bool is_of_times(const ExperimentInfo& info) { return info.attribute == "table_size"; }

std::vector<TimeRow> time_rows(const ExperimentInfo& info, const std::vector<StudyRecord>& records) {
  std::vector<TimeRow> rows;
  for (const StudyLevel& level : info.levels)
    for (const std::string& method : info.methods) {
      std::vector<double> times;
      for (const StudyRecord& record : records)
        if (record.experiment == info.name && record.level == level.label && record.method == method && record.time_ms)
          times.push_back(*record.time_ms);
      if (times.empty()) continue;
      rows.push_back({info.name, info.dataset, level.label, method, static_cast<int>(times.size()),
                      quantile_of(times, 0.5), mean_of(times), quantile_of(times, 0.25), quantile_of(times, 0.75)});
    }
  return rows;
}

std::string time_text(const std::vector<TimeRow>& rows) {
  std::string text = "experiment,dataset,level,method,runs,median_ms,mean_ms,lower_quartile_ms,upper_quartile_ms\n";
  for (const TimeRow& row : rows) {
    std::vector<std::string> cells = {row.experiment, row.dataset, row.level, row.method, std::to_string(row.runs)};
    for (const double time : {row.median_ms, row.mean_ms, row.lower_quartile_ms, row.upper_quartile_ms})
      cells.push_back(to_text(time));
    text += csv_line(cells);
  }
  return text;
}

std::vector<StudyResults> tables_of(const std::vector<StudyFolder>& runs) {
  std::vector<StudyResults> results;
  for (const StudyFolder& run : runs) results.push_back({&run, experiment_tables(run), {}});
  return results;
}

std::vector<StudyResults> results_of(const std::vector<StudyFolder>& runs, const ParallelFor& parallel_for) {
  std::vector<StudyResults> results = tables_of(runs);
  for (StudyResults& study : results) study.summary = summarize(study.tables, parallel_for);
  return results;
}

std::vector<StudyFolder> read_runs(const std::vector<std::string>& folders) {
  std::vector<StudyFolder> runs;
  for (const std::string& folder : folders) runs.push_back(read_study(folder));
  return runs;
}

namespace {

/// Empty if it does not begin with the prefix.
std::string without_prefix(const std::string& name, const std::string& prefix) {
  return name.compare(0, prefix.size(), prefix) == 0 ? name.substr(prefix.size()) : "";
}

}  // namespace

void keep_methods_named(const std::string& prefix, std::vector<StudyFolder>& runs) {
  std::size_t kept = 0;
  for (StudyFolder& run : runs) {
    for (ExperimentInfo& info : run.experiments) {
      std::vector<std::string> methods;
      for (const std::string& method : info.methods)
        if (const std::string name = without_prefix(method, prefix); !name.empty()) methods.push_back(name);
      kept += methods.size();
      info.methods = std::move(methods);
    }
    std::vector<StudyRecord> records;
    for (StudyRecord& record : run.records) {
      const std::string name = without_prefix(record.method, prefix);
      if (name.empty()) continue;
      record.method = name;
      records.push_back(std::move(record));
    }
    run.records = std::move(records);
  }
  if (kept == 0)
    throw InvalidInput("claims", "prefix", quoted(prefix), "the beginning of a method's name in the studies");
}

}  // namespace corral
