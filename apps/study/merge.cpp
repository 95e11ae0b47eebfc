// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <map>

#include "apps/study/finish_study.h"
#include "apps/study/manifest.h"
#include "apps/study/plan.h"
#include "apps/study/study.h"
#include "apps/study/study_journals.h"
#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNamed = 5;

/// A few of these, and how many more.
std::string enumeration(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), kMostNamed); ++i) text += (i > 0 ? ", " : "") + items[i];
  if (items.size() > kMostNamed) text += " and " + std::to_string(items.size() - kMostNamed) + " more";
  return text;
}

/// Copies a file unless the same is there.
void copy_to(const fs::path& from, const fs::path& to) {
  const std::string content = read_file(from.string());
  std::error_code ignored;
  if (fs::exists(to, ignored)) {
    if (read_file(to.string()) == content) return;
    throw IoError(from.string(), "", "differs from " + to.string() + ", expected parts of one study");
  }
  make_folder(to.parent_path().string());
  write_file(to.string(), content);
}

/// Brings the files of shards that were written to a folder of their own.
void bring(const std::string& part, const std::string& folder) {
  std::error_code ignored;
  if (find_journals(part).empty()) throw IoError(part, "", "has no journals, expected the folder of a shard");
  for (const char* room : {"selections", "units"})  // the journals last: then what they name is there
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(part) / room, ignored)) {
      const std::string ending = entry.path().extension().string();
      if (entry.is_regular_file(ignored) && (ending == ".csv" || ending == ".journal"))
        copy_to(entry.path(), folder / entry.path().lexically_relative(part));  // wherever a link leads
    }
}

/// What stands in the way of a whole study: the shards that have not done all of their pairs. Of several numbers of shards in
/// one folder, that with the most journals is the one that is named.
std::string unfinished_text(const WorkList& list, const FinishedUnits& finished,
                            const std::vector<JournalFile>& journals) {
  std::map<int, int> uses;
  for (const JournalFile& journal : journals) ++uses[journal.shard.count];
  const int count = std::max_element(uses.begin(), uses.end(), [](const auto& a, const auto& b) {
                      return a.second < b.second;
                    })->first;
  const std::vector<int> shard_of = split_units(estimate_units(list), count);
  std::vector<int> pairs(static_cast<std::size_t>(count)), done = pairs;
  for (std::size_t unit = 0; unit < shard_of.size(); ++unit) {
    const auto shard = static_cast<std::size_t>(shard_of[unit] - 1);
    ++pairs[shard];
    done[shard] += finished.has(unit);
  }
  std::vector<std::string> missing, unfinished;
  for (std::size_t shard = 0; shard < pairs.size(); ++shard) {
    if (done[shard] == pairs[shard]) continue;
    const std::string name = to_text(Shard{static_cast<int>(shard) + 1, count});
    if (done[shard] == 0)
      missing.push_back(name);
    else
      unfinished.push_back(name + " (" + std::to_string(done[shard]) + " of " + std::to_string(pairs[shard]) +
                           " pairs)");
  }
  std::string text;
  if (!missing.empty()) text += "missing " + enumeration(missing);
  if (!unfinished.empty()) text += (text.empty() ? "" : ", ") + ("unfinished " + enumeration(unfinished));
  return text;
}

std::vector<std::string> notes_of(const FinishedUnits& finished) {
  std::vector<std::string> notes;
  for (const auto& [shards, units] : finished.overlaps())
    notes.push_back("shards " + to_text(shards.first) + " and " + to_text(shards.second) +
                    " overlap: " + std::to_string(units) + " pairs are in both, with the same results");
  std::set<std::string> processors;
  for (const std::string& machine : finished.machines())
    processors.insert(Json::parse(machine).value("processor", std::string()));
  if (processors.size() > 1)
    notes.push_back("times were taken on different processors: " + enumeration({processors.begin(), processors.end()}) +
                    "; compare them with care");
  return notes;
}

}  // namespace

MergeOutcome merge_study(const std::string& folder, const std::vector<std::string>& parts, const std::string& data) {
  const FolderLock lock(folder);
  for (const std::string& part : parts) bring(part, folder);
  const StudyJournals study = find_study(folder);
  const WorkList list = work_list_of(study, data);
  FinishedUnits finished(list, folder, hash_answers(list));
  std::vector<std::string> damaged;
  for (const JournalFile& journal : study.files) {
    JournalReader reader(journal.path);
    finished.add(reader, journal);
    for (const int line : reader.damaged_lines()) damaged.push_back(journal.path + " line " + std::to_string(line));
  }
  finished.drop_unreadable();
  const std::string unfinished = unfinished_text(list, finished, study.files);
  const std::string damage = damaged.empty() ? "" : " (damaged: " + enumeration(damaged) + ")";
  const std::string outdated = finished.outdated() == 0
                                   ? ""
                                   : " (" + std::to_string(finished.outdated()) +
                                         " results were made from answers of other programs that have changed)";
  if (!unfinished.empty())
    throw IoError(folder, "",
                  "is not whole: " + unfinished + damage + outdated +
                      "; repeat these shards, or 'corral evaluate' without --shard");
  MergeOutcome outcome{finish_study(list, finished, folder, study.command_line), notes_of(finished)};
  if (!damaged.empty()) outcome.notes.push_back("damaged and done again elsewhere: " + enumeration(damaged));
  return outcome;
}

}  // namespace corral
