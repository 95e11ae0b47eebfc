// SPDX-License-Identifier: MIT
#include "apps/results/set_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "apps/results/statistics.h"
#include "kernel/number_text.h"

namespace corral {

const std::vector<double> kMatchCounts = {300, 1000, 3000, std::numeric_limits<double>::infinity()};

namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
const char* const kOracle = "oracle";
const std::vector<std::string> kNumbers = {"success_5pr", "initial_success_5pr", "precision", "recall"};

double at(const RowNumbers* column, std::size_t row) { return column ? (*column)[row] : kAbsent; }

class SetTableBuilder {
 public:
  explicit SetTableBuilder(const std::string& dataset) { table_.dataset = dataset; }

  void add(const StudyResults& study, const ExperimentTable& experiment) {
    std::vector<std::string> methods = experiment.info.methods;
    methods.push_back(kOracle);
    for (const std::string& method : methods) add_method(method);
    for (const LevelTable& level : experiment.levels)
      for (std::size_t row = 0; row < level.pairs.size(); ++row)
        if (level.roles[row] == PairRole::Judged && known_.insert(level.pairs[row]).second)
          add_row(level, row, methods);
    for (const StudyRecord& record : study.run->records)
      if (record.experiment == experiment.info.name && record.dataset == experiment.info.dataset && record.time_ms)
        times_[record.method].push_back(*record.time_ms);
  }

  SetTable table() && {
    for (auto& [method, times] : times_) table_.median_ms[method] = quantile_of(std::move(times), 0.5);
    // The oracle stands last.
    std::stable_partition(table_.methods.begin(), table_.methods.end(),
                          [](const std::string& method) { return method != kOracle; });
    return std::move(table_);
  }

 private:
  void add_method(const std::string& method) {
    const auto [place, is_new] = table_.numbers.try_emplace(method);
    if (!is_new) return;
    table_.methods.push_back(method);
    for (const std::string& name : kNumbers) place->second[name].assign(table_.pairs.size(), kAbsent);
  }

  void add_row(const LevelTable& level, std::size_t row, const std::vector<std::string>& methods) {
    table_.pairs.push_back(level.pairs[row]);
    table_.matches.push_back(at(level.column(measure("matches"), ""), row));
    table_.correct_share.push_back(at(level.column(measure("inlier_ratio"), ""), row));
    for (auto& [method, columns] : table_.numbers) {
      const bool is_here = std::find(methods.begin(), methods.end(), method) != methods.end();
      for (auto& [name, column] : columns)
        column.push_back(is_here ? at(level.column(measure(name), method), row) : kAbsent);
    }
  }

  SetTable table_;
  std::set<std::string> known_;
  std::map<std::string, std::vector<double>> times_;
};

std::size_t match_count_bin(double matches) {
  const auto place = std::upper_bound(kMatchCounts.begin(), kMatchCounts.end() - 1, matches);
  return static_cast<std::size_t>(place - kMatchCounts.begin());
}

MethodShare share_of(const SetTable& table, const std::string& method, const std::vector<std::size_t>& rows) {
  RowNumbers within;
  for (const std::size_t row : rows) within.push_back(table.column(method, "success_5pr")[row]);
  MethodShare share{success_share(within), method, {}};
  const auto time = table.median_ms.find(method);
  if (time != table.median_ms.end()) share.median_ms = time->second;
  return share;
}

/// The best first, the faster of equals; without the oracle and methods that were not tried on these rows.
std::vector<MethodShare> shares_of(const SetTable& table, const std::vector<std::size_t>& rows) {
  std::vector<MethodShare> shares;
  for (const std::string& method : table.methods) {
    if (method == kOracle) continue;
    MethodShare share = share_of(table, method, rows);
    if (share.pairs > 0) shares.push_back(std::move(share));
  }
  const auto time = [](const MethodShare& share) {
    return share.median_ms.value_or(std::numeric_limits<double>::infinity());
  };
  std::stable_sort(shares.begin(), shares.end(), [&](const MethodShare& a, const MethodShare& b) {
    return a.success != b.success ? a.success > b.success : time(a) < time(b);
  });
  return shares;
}

}  // namespace

std::vector<SetTable> set_tables(const std::vector<StudyResults>& studies) {
  struct Source {
    const StudyResults* study;
    const ExperimentTable* experiment;
  };
  std::vector<std::string> datasets;
  std::map<std::string, std::vector<Source>> sources;
  for (const StudyResults& study : studies)
    for (const ExperimentTable& experiment : study.tables) {
      if (is_of_times(experiment.info)) continue;
      auto& of_set = sources[experiment.info.dataset];
      if (of_set.empty()) datasets.push_back(experiment.info.dataset);
      of_set.push_back({&study, &experiment});
    }
  std::vector<SetTable> tables;
  for (const std::string& dataset : datasets) {
    std::vector<Source>& of_set = sources[dataset];
    std::stable_sort(of_set.begin(), of_set.end(), [](const Source& a, const Source& b) {
      return a.experiment->info.methods.size() > b.experiment->info.methods.size();
    });
    SetTableBuilder builder(dataset);
    for (const Source& source : of_set) builder.add(*source.study, *source.experiment);
    SetTable table = std::move(builder).table();
    if (!table.pairs.empty()) tables.push_back(std::move(table));
  }
  return tables;
}

std::string match_count_text(std::size_t bin) {
  const std::string from = to_text(bin == 0 ? 0 : kMatchCounts[bin - 1]);
  return std::isinf(kMatchCounts[bin]) ? from + " and more" : from + " to " + to_text(kMatchCounts[bin]);
}

MethodChoice choose_method(const SetTable& table) {
  MethodChoice choice;
  choice.dataset = table.dataset, choice.pairs = static_cast<int>(table.pairs.size());
  std::vector<std::size_t> all;
  std::vector<std::vector<std::vector<std::size_t>>> rows(kCorrectShares.size(),
                                                          std::vector<std::vector<std::size_t>>(kMatchCounts.size()));
  for (std::size_t row = 0; row < table.pairs.size(); ++row) {
    all.push_back(row);
    if (std::isnan(table.correct_share[row]) || std::isnan(table.matches[row])) continue;
    rows[correct_share_bin(table.correct_share[row])][match_count_bin(table.matches[row])].push_back(row);
  }
  choice.methods = shares_of(table, all);
  for (const MethodShare& each : choice.methods)
    choice.is_on_front.push_back(
        each.median_ms && std::none_of(choice.methods.begin(), choice.methods.end(), [&](const MethodShare& other) {
          return other.median_ms && other.success >= each.success && *other.median_ms < *each.median_ms;
        }));
  if (const MethodShare perfect = share_of(table, kOracle, all); perfect.pairs > 0) choice.perfect = perfect;
  for (const auto& by_count : rows) {
    auto& cells = choice.cells.emplace_back();
    for (const std::vector<std::size_t>& of_cell : by_count) {
      ChoiceCell& cell = cells.emplace_back();
      cell.pairs = static_cast<int>(of_cell.size());
      for (MethodShare& share : shares_of(table, of_cell))
        if (cell.best.empty() || share.high >= cell.best.front().success) cell.best.push_back(std::move(share));
    }
  }
  return choice;
}

}  // namespace corral
