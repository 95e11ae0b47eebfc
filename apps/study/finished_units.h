// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "apps/study/journal.h"

namespace corral {

/// The finished units of a study, put together from its journals.
class FinishedUnits {
 public:
  /// `inputs`: hashes of the files as they are now, where they are known.
  FinishedUnits(const WorkList& list, std::string folder, InputHashes inputs);

  /// Takes the entries of a journal that are whole, belong to a unit, and whose files of selections are there. Of several
  /// results of a unit the first counts; where another program has answered anew, only that of the latest call of a shard may,
  /// which comes first. Throws IoError if a file of the pair had another content then, or two results differ.
  void add(JournalReader& reader, const JournalFile& journal);
  void add(std::size_t unit, JournalEntry entry, const JournalFile& journal);
  void add_machine(const Json& machine) { machines_.insert(compact_json(machine)); }

  /// Takes back the pairs that failed because a file could not be read which can be read now, or could in another shard.
  void drop_unreadable();

  /// How many results were left out because an answer of another program is another now, or in a result before.
  std::size_t outdated() const { return outdated_.size(); }

  bool has(std::size_t unit) const { return unit_files_[unit].has_value(); }
  const std::vector<UnitResult>& results() const {
    return results_;
  }                                                                ///< one for each unit, empty unless it is finished
  const InputHashes& inputs() const { return inputs_; }            ///< of all files that are known
  const std::vector<double>& seconds() const { return seconds_; }  ///< that each unit took
  const std::set<std::string>& machines() const { return machines_; }  ///< MachineInfo of the journals, as JSON
  /// How many units two different shards both have.
  const std::map<std::pair<Shard, Shard>, int>& overlaps() const { return overlaps_; }

 private:
  struct UnitFiles {
    std::vector<std::string> hashes;
    JournalFile journal;
  };

  bool has_selections(std::size_t unit) const;
  bool is_outdated(std::size_t unit, const JournalEntry& entry);
  void note_input(const std::string& file, const std::string& hash, const JournalFile& journal);

  const WorkList& list_;
  std::string folder_;
  InputHashes inputs_;
  std::unordered_map<std::string, std::size_t> unit_of_key_;
  std::vector<std::optional<UnitFiles>> unit_files_;
  std::vector<UnitResult> results_;
  std::vector<double> seconds_;
  std::set<std::string> machines_;
  std::map<std::pair<Shard, Shard>, int> overlaps_;
  std::set<std::pair<std::size_t, Shard>> outdated_;  ///< there the latest answer is not the present one
};

/// Whether a result has everything that the unit requires.
bool fits(const UnitResult& result, const WorkUnit& unit);

}  // namespace corral
