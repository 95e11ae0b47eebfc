// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/study/evaluate_unit.h"
#include "apps/study/shard.h"
#include "apps/study/study_call.h"
#include "io/disk/append_file.h"

namespace corral {

/// What two calls must agree on to work on one study.
struct StudyIdentity {
  std::string version, commit;  ///< of the program
  std::string experiments;      ///< hash of all units and settings
  /// "by commit .. of the program", "from other experiments or settings"; empty if they agree.
  std::string difference_from(const StudyIdentity& mine) const;
};

/// The first line of a journal.
struct JournalHeader {
  StudyIdentity identity;
  Shard shard;
  StudyCall call;
  std::string command_line;
  Json machine;  ///< of build_info.h
};

/// A line of a journal: a unit that is finished.
struct JournalEntry {
  std::string unit;                 ///< unit_key
  std::vector<std::string> inputs;  ///< hashes of WorkUnit::files; empty where there was none to read
  double seconds = 0;               ///< that it took
  UnitResult result;
};

/// The file of finished units of one call, `units/3-of-7.1.journal` (shard 3 of 7, first call): a line each with the hash of
/// its content before it. Every call has a file of its own, so that no two ever write to one, whatever the file system.
/// A unit counts once its line is on the disk.
class JournalWriter {
 public:
  /// In the folder of the study; the file appears with the first entry.
  JournalWriter(std::string folder, JournalHeader header) : folder_(std::move(folder)), header_(std::move(header)) {}
  void append(const JournalEntry& entry);  ///< throws IoError; then the entry is not there

 private:
  std::string folder_;
  JournalHeader header_;
  std::optional<AppendFile> file_;
};

/// The name of a journal, taken apart.
struct JournalFile {
  std::string path;
  Shard shard;
  int call = 1;
};

/// The journals in the folder `units` of a study, by shard, the latest call first; of one shard if it is given. Empty without the folder.
std::vector<JournalFile> find_journals(const std::string& folder, const std::optional<Shard>& shard = std::nullopt);

/// Reads a journal from first to last line.
class JournalReader {
 public:
  explicit JournalReader(const std::string& path);  ///< throws IoError

  /// Absent if the first line is not whole. Throws IoError if it is that of no journal.
  const std::optional<JournalHeader>& header() const { return header_; }

  /// The next entry whose line agrees with its hash; absent at the end.
  std::optional<JournalEntry> next();

  /// Of the lines so far, those that do not agree with their hash. A last line without its end is not among them: there the
  /// call ended while it wrote.
  const std::vector<int>& damaged_lines() const { return damaged_lines_; }

 private:
  std::optional<std::string_view> next_line();

  std::string text_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::optional<JournalHeader> header_;
  std::vector<int> damaged_lines_;
};

}  // namespace corral
