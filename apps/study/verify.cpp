// SPDX-License-Identifier: MIT
#include "apps/study/verify.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <mutex>

#include "apps/runtime/temporary_folder.h"
#include "apps/runtime/workers.h"
#include "apps/study/assemble.h"
#include "apps/study/finished_units.h"
#include "apps/study/manifest.h"
#include "apps/study/study_journals.h"
#include "io/disk/file.h"
#include "io/text/csv_file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// "is '1' in the study, '2' when it is computed again".
std::string differs(const std::string& kept, const std::string& now, const char* where) {
  return "is " + corral::quoted(kept) + " in the study, " + corral::quoted(now) + " " + where;
}
constexpr const char* kAgain = "when it is computed again";

/// What is in a file, or nothing if it cannot be read.
std::optional<std::string> content_of(const std::string& path) {
  try {
    return read_file(path);
  } catch (const IoError&) {
    return std::nullopt;
  }
}

std::string line_of(std::string_view text, std::size_t at) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  return std::string(text.substr(at, end - at));
}

/// Where two texts differ first.
std::string first_difference(const std::string& kept, const std::string& again) {
  std::size_t at = 0, begin = 0;
  int line = 1;
  for (; at < std::min(kept.size(), again.size()) && kept[at] == again[at]; ++at)
    if (kept[at] == '\n') ++line, begin = at + 1;
  return "line " + std::to_string(line) + ": " + differs(line_of(kept, begin), line_of(again, begin), kAgain);
}

/// The cells of a line of records.csv; none if it is no such line.
std::vector<std::string> cells_of(const std::string& line) {
  try {
    const CsvTable table = parse_csv("records.csv", records_header() + line + "\n");
    return table.rows.size() == 1 ? table.rows.front() : std::vector<std::string>();
  } catch (const IoError&) {
    return {};
  }
}

/// The columns, times apart, in which two lines of records.csv differ.
std::vector<std::string> cell_differences(const std::string& kept, const std::string& line, const char* where) {
  std::vector<std::string> differences;
  const std::vector<std::string> before = cells_of(kept), now = cells_of(line);
  if (before.size() != now.size()) return {"the line " + differs(kept, line, where)};
  for (std::size_t column = 0; column < now.size(); ++column)
    if (before[column] != now[column] && record_columns()[column] != "time_ms")
      differences.push_back(record_columns()[column] + " " + differs(before[column], now[column], where));
  return differences;
}

/// Compares one study with what its inputs give.
class Verifier {
 public:
  Verifier(const WorkList& list, const FinishedUnits& finished, const VerifySettings& settings)
      : list_(list), finished_(finished), folder_(settings.folder), store_(cache_.path()) {}

  VerifyOutcome verify(const VerifySettings& settings, const std::function<void(const StudyProgress&)>& progress) {
    outcome_.of = list_.units.size();
    compare_journals();
    const std::vector<std::size_t> units = draw(settings);
    inputs_ = hash_inputs(list_, units, settings.jobs);
    compare_inputs();
    std::vector<std::vector<std::string>> found(units.size());
    StudyProgress now;
    now.total = units.size();
    progress(now);
    workers(settings.jobs)(static_cast<int>(units.size()), [&](int i) {
      std::vector<std::string>& differences = found[static_cast<std::size_t>(i)];
      const std::size_t unit = units[static_cast<std::size_t>(i)];
      std::vector<FileContent> files;
      const UnitResult again = evaluate_unit({list_.units[unit], inputs_, store_}, files);
      compare_files(files, differences);
      const std::size_t records = compare_records(unit, again, differences);
      const std::lock_guard<std::mutex> guard(mutex_);
      outcome_.files += files.size();
      outcome_.records += records;
      ++now.done;
      progress(now);
    });
    outcome_.pairs = units.size();
    for (std::vector<std::string>& differences : found)
      std::move(differences.begin(), differences.end(), std::back_inserter(outcome_.differences));
    return std::move(outcome_);
  }

 private:
  std::string name_of(std::size_t unit) const {
    return "pair " + list_.units[unit].dataset + "/" + list_.units[unit].pair.name;
  }

  /// Units that have a result, without repetition, in their order.
  std::vector<std::size_t> draw(const VerifySettings& settings) {
    std::vector<std::size_t> units;
    for (std::size_t unit = 0; unit < list_.units.size(); ++unit)
      if (finished_.has(unit)) units.push_back(unit);
    if (!settings.sample) return units;
    const std::size_t count = std::min(units.size(), static_cast<std::size_t>(*settings.sample));
    RandomStream random(settings.seed);
    for (std::size_t i = 0; i < count; ++i) std::swap(units[i], units[i + random.below(units.size() - i)]);
    units.resize(count);
    std::sort(units.begin(), units.end());
    return units;
  }

  /// Every pair must have a whole result, and the lines of records.csv must be those of the results.
  void compare_journals() {
    bool is_whole = true;
    for (std::size_t unit = 0; unit < list_.units.size(); ++unit) {
      if (finished_.has(unit)) continue;
      is_whole = false;
      outcome_.differences.push_back(name_of(unit) + ": has no whole result in units/, or its selections are missing");
    }
    if (!is_whole) return;
    const std::string path = (folder_ / "records.csv").string(), kept = read_file(path);
    std::size_t at = 0;
    int line = 0;
    const auto compare = [&](const std::string& text) {
      for (std::size_t from = 0; from < text.size();) {
        const std::string now = line_of(text, from), before = at < kept.size() ? line_of(kept, at) : "";
        ++line;
        if (now != before)
          for (const std::string& difference : cell_differences(before, now, "in its journals"))
            outcome_.differences.push_back(path + ", line " + std::to_string(line) + ": " + difference);
        from += now.size() + 1;
        at += before.size() + 1;
      }
    };
    compare(records_header());
    for (std::size_t experiment = 0; experiment < list_.experiments.size(); ++experiment)
      assemble_records(list_, finished_.results(), static_cast<int>(experiment),
                       [&](int, const std::vector<StudyRecord>& records) { compare(records_text(records)); });
    if (at < kept.size())
      outcome_.differences.push_back(path + ", line " + std::to_string(line + 1) + ": is no record of the study");
  }

  void compare_inputs() {
    for (const auto& [file, hash] : inputs_)
      if (const std::string before = hash_of(finished_.inputs(), file); !before.empty() && before != hash)
        outcome_.differences.push_back(
            file + ": " + (hash.empty() ? "cannot be read" : "is not the file that the study was made from"));
  }

  void compare_files(const std::vector<FileContent>& files, std::vector<std::string>& differences) const {
    for (const FileContent& file : files) {
      const std::string path = (folder_ / file.path).string();
      const std::optional<std::string> kept = content_of(path);
      if (!kept)
        differences.push_back(path + ": cannot be read, but computing the pair again gives it");
      else if (*kept != file.content)
        differences.push_back(path + ", " + first_difference(*kept, file.content));
    }
  }

  /// The lines that a result of a unit gives in all experiments.
  std::vector<std::string> lines_of(std::size_t unit, const UnitResult& result) const {
    WorkList alone{list_.experiments, {list_.units[unit]}, {}};
    for (StudySample sample : list_.samples) {
      if (static_cast<std::size_t>(sample.unit) != unit) continue;
      sample.unit = 0;
      alone.samples.push_back(std::move(sample));
    }
    std::vector<std::string> lines;
    for (std::size_t experiment = 0; experiment < list_.experiments.size(); ++experiment)
      assemble_records(alone, {result}, static_cast<int>(experiment),
                       [&](int, const std::vector<StudyRecord>& records) {
                         for (const StudyRecord& record : records) lines.push_back(record_line(record));
                       });
    return lines;
  }

  /// Returns how many were compared.
  std::size_t compare_records(std::size_t unit, const UnitResult& again, std::vector<std::string>& differences) const {
    const UnitResult& result = finished_.results()[unit];
    const std::vector<std::string> kept = lines_of(unit, result), now = lines_of(unit, again);
    if (kept.size() != now.size()) {
      differences.push_back(name_of(unit) + ": " + std::to_string(kept.size()) + " records in the study, " +
                            std::to_string(now.size()) + " when it is computed again");
      return 0;
    }
    const auto column = [](const std::string& name) {
      return static_cast<std::size_t>(std::find(record_columns().begin(), record_columns().end(), name) -
                                      record_columns().begin());
    };
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (now[i] == kept[i]) continue;
      const std::vector<std::string> cells = cells_of(now[i].substr(0, now[i].size() - 1));
      for (const std::string& difference : cell_differences(line_of(kept[i], 0), line_of(now[i], 0), kAgain))
        differences.push_back(name_of(unit) + ", " + cells[column("experiment")] + ", " + cells[column("method")] +
                              ": " + difference);
    }
    return now.size();
  }

  const WorkList& list_;
  const FinishedUnits& finished_;
  const fs::path folder_;
  const TemporaryFolder cache_;
  const ContentStore store_;
  InputHashes inputs_;
  std::mutex mutex_;  ///< of the outcome and the progress
  VerifyOutcome outcome_;
};

/// A study may come from anyone, and with it what it calls.
void check_programs(const StudyCall& call, const std::string& folder) {
  std::string commands;
  for (const ExternalMethod& external : call.externals)
    commands += (commands.empty() ? "" : ", ") + corral::quoted(external.command);
  if (!commands.empty())
    throw IoError(folder, "", "calls other programs: " + commands + "; expected --programs, if these may run here");
}

}  // namespace

VerifyOutcome verify_study(const VerifySettings& settings, const std::function<void(const StudyProgress&)>& progress) {
  const StudyJournals study = find_study(settings.folder);
  if (!settings.programs) check_programs(study.call, settings.folder);
  const WorkList list = work_list_of(study, settings.data);
  FinishedUnits finished(list, settings.folder, {});
  for (const JournalFile& journal : study.files) {
    JournalReader reader(journal.path);
    finished.add(reader, journal);
  }
  return Verifier(list, finished, settings).verify(settings, progress);
}

}  // namespace corral
