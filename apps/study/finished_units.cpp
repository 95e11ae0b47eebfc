// SPDX-License-Identifier: MIT
#include "apps/study/finished_units.h"

#include <algorithm>
#include <filesystem>

#include "kernel/error.h"

namespace corral {
namespace {

/// What does not depend on the clock.
std::string lasting_text(UnitResult result) {
  for (TaskResult& task : result.tasks) task.time_ms.reset();
  for (TaskResult& oracle : result.oracles) oracle.time_ms.reset();
  if (result.baseline) result.baseline->time_ms.reset();
  return compact_json(to_json(result));
}

}  // namespace

bool fits(const UnitResult& result, const WorkUnit& unit) {
  if (!result.failure.empty()) return true;
  const std::size_t thresholds = result.has_truth ? unit.thresholds_pr.size() : 0;
  const auto is_whole = [&](const TaskResult& task) {
    if (task.correct.size() != (task.selected ? thresholds : 0)) return false;
    if (!task.true_matches.empty() && task.true_matches.size() != task.correct.size()) return false;
    const std::vector<int>& right = task.true_matches.empty() ? result.true_matches : task.true_matches;
    for (std::size_t i = 0; i < task.correct.size(); ++i)
      if (task.correct[i] > std::min(*task.selected, right[i])) return false;
    return true;
  };
  return result.tasks.size() == unit.tasks.size() && result.true_matches.size() == thresholds &&
         result.frame_share.size() == thresholds && result.oracles.size() == thresholds &&
         result.baseline.has_value() == result.has_truth &&
         std::all_of(result.tasks.begin(), result.tasks.end(), is_whole) &&
         std::all_of(result.oracles.begin(), result.oracles.end(), is_whole) &&
         (!result.baseline || is_whole(*result.baseline));
}

FinishedUnits::FinishedUnits(const WorkList& list, std::string folder, InputHashes inputs)
    : list_(list),
      folder_(std::move(folder)),
      inputs_(std::move(inputs)),
      unit_files_(list.units.size()),
      results_(list.units.size()),
      seconds_(list.units.size()) {
  unit_of_key_.reserve(list.units.size());
  for (std::size_t unit = 0; unit < list.units.size(); ++unit) unit_of_key_[unit_key(list.units[unit])] = unit;
}

void FinishedUnits::add(JournalReader& reader, const JournalFile& journal) {
  if (reader.header()) add_machine(reader.header()->machine);
  while (auto entry = reader.next()) {
    const auto found = unit_of_key_.find(entry->unit);
    if (found == unit_of_key_.end() || !fits(entry->result, list_.units[found->second])) continue;
    if (entry->inputs.size() != list_.units[found->second].files().size()) continue;
    if (entry->result.failure.empty() && !has_selections(found->second)) continue;
    if (outdated_.count({found->second, journal.shard}) > 0) continue;
    if (is_outdated(found->second, *entry)) {
      outdated_.insert({found->second, journal.shard});
      continue;
    }
    add(found->second, std::move(*entry), journal);
  }
}

bool FinishedUnits::is_outdated(std::size_t unit, const JournalEntry& entry) {
  const std::vector<std::string> names = list_.units[unit].files();
  const std::size_t of_pair = list_.units[unit].pair.files().size();
  for (std::size_t i = of_pair; i < names.size(); ++i)
    if (inputs_.try_emplace(names[i], entry.inputs[i]).first->second != entry.inputs[i]) return true;
  return false;
}

void FinishedUnits::add(std::size_t unit, JournalEntry entry, const JournalFile& journal) {
  const DatasetPair& pair = list_.units[unit].pair;
  const std::vector<std::string> names = pair.files();
  for (std::size_t i = 0; i < names.size(); ++i) note_input(names[i], entry.inputs[i], journal);
  auto& files = unit_files_[unit];
  UnitFiles now{std::move(entry.inputs), journal};
  const auto unreadable = [](const UnitFiles& of) { return std::count(of.hashes.begin(), of.hashes.end(), ""); };
  if (files) {
    if (!(files->journal.shard == journal.shard)) ++overlaps_[std::minmax(files->journal.shard, journal.shard)];
    const auto before = unreadable(*files), after = unreadable(now);
    if (after == before && lasting_text(results_[unit]) != lasting_text(entry.result))
      throw IoError(journal.path, "",
                    "has another result of the pair " + pair.name + " than " + files->journal.path +
                        ", expected the same from the same program and files");
    if (after >= before) return;
  }
  files = std::move(now);
  results_[unit] = std::move(entry.result);
  seconds_[unit] = entry.seconds;
}

void FinishedUnits::drop_unreadable() {
  for (std::size_t unit = 0; unit < list_.units.size(); ++unit) {
    auto& files = unit_files_[unit];
    if (!files) continue;
    const std::vector<std::string> names = list_.units[unit].pair.files();
    bool is_readable = false;
    for (std::size_t i = 0; i < names.size(); ++i)
      is_readable = is_readable || (files->hashes[i].empty() && !hash_of(inputs_, names[i]).empty());
    if (!is_readable) continue;
    files.reset();
    results_[unit] = {};
  }
}

bool FinishedUnits::has_selections(std::size_t unit) const {
  const auto& selections = list_.units[unit].selections;
  std::error_code ignored;
  return std::all_of(selections.begin(), selections.end(), [&](const auto& selection) {
    return std::filesystem::exists(std::filesystem::path(folder_) / selection.first, ignored);
  });
}

void FinishedUnits::note_input(const std::string& file, const std::string& hash, const JournalFile& journal) {
  if (file.empty() || hash.empty()) return;
  std::string& known = inputs_[file];
  if (known.empty()) known = hash;
  if (known != hash)
    throw IoError(journal.path, "",
                  "was made from a different version of " + file +
                      ", expected the same data for the whole study (or another folder for -o)");
}

}  // namespace corral
