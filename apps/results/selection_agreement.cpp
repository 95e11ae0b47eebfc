// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>

#include "apps/results/level_table.h"

namespace corral {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

double jaccard(const Indices& a, const Indices& b) {
  Indices both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  const std::size_t either = a.size() + b.size() - both.size();
  return either > 0 ? static_cast<double>(both.size()) / static_cast<double>(either) : kAbsent;
}

double agreement(const PairSelections& selections, const std::vector<std::string>& methods) {
  RowNumbers indices;
  for (auto a = selections.selected.begin(); a != selections.selected.end(); ++a)
    for (auto b = std::next(a); b != selections.selected.end(); ++b)
      if (std::count(methods.begin(), methods.end(), a->first) && std::count(methods.begin(), methods.end(), b->first))
        indices.push_back(jaccard(a->second, b->second));
  return mean_of(indices);
}

}  // namespace

std::vector<RowNumbers> selection_agreement(const StudyFolder& run, const ExperimentTable& table,
                                            const std::vector<std::string>& methods) {
  std::map<std::string, double> known;
  std::vector<RowNumbers> agreements;
  for (const LevelTable& level : table.levels) {
    RowNumbers& column = agreements.emplace_back();
    for (const std::string& selection : level.selections) {
      const std::string file = (std::filesystem::path(run.folder) / selection).string();
      const auto [entry, is_new] = known.try_emplace(selection, kAbsent);
      if (is_new && !selection.empty() && std::filesystem::exists(file))
        entry->second = agreement(read_selections(file), methods);
      column.push_back(entry->second);
    }
  }
  return agreements;
}

}  // namespace corral
