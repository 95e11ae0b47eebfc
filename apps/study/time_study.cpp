// SPDX-License-Identifier: MIT
#include "apps/study/time_study.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>

#include "apps/pair/methods.h"
#include "apps/pair/read_surface.h"
#include "apps/results/study_results.h"
#include "apps/runtime/stopwatch.h"
#include "apps/study/assemble.h"
#include "apps/study/manifest.h"
#include "io/matches/matches_file.h"
#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {
namespace {

constexpr double kShortCall_ms = 1;
constexpr int kCallsOfShort = 100;

struct Table {
  const WorkUnit* unit;
  CorrespondenceSet matches;
};

/// The tables of the first units that have enough rows for the largest size, else those with most rows.
std::vector<Table> find_tables(const WorkList& list, const InputHashes& inputs, const ContentStore& store) {
  const Experiment& experiment = list.experiments.front();
  double largest = 0;
  for (const StudyLevel& level : experiment.info.levels) largest = std::max(largest, level.high);
  std::vector<Table> tables;
  const auto is_enough = [&](const Table& table) { return table.matches.size() >= largest; };
  const auto wanted = static_cast<std::size_t>(experiment.tables);
  for (const WorkUnit& unit : list.units) {
    if (unit.pair.matches.empty()) {
      const Mesh source = read_surface(unit.pair.source), target = read_surface(unit.pair.target);
      tables.push_back({&unit, unit_matches({unit, inputs, store}, source, target).matches});
    } else {
      tables.push_back({&unit, read_matches(unit.pair.matches)});
    }
    if (static_cast<std::size_t>(std::count_if(tables.begin(), tables.end(), is_enough)) == wanted) break;
  }
  std::stable_sort(tables.begin(), tables.end(), [&](const Table& a, const Table& b) {
    return std::min<double>(a.matches.size(), largest) > std::min<double>(b.matches.size(), largest);
  });
  if (tables.size() > wanted) tables.resize(wanted);
  return tables;
}

/// Times methods on one table.
class Timer {
 public:
  Timer(const WorkUnit& unit, const CorrespondenceSet& matches) : matches_(matches) {
    for (const GroupingTask& task : unit.tasks) {
      if (task.repeat > 0) continue;  // the same call is repeated here
      methods_.push_back(task.method);
      calls_.push_back(find_method(task.method).configure(task.options).group);
      Stopwatch watch;
      selected_.push_back(static_cast<int>(calls_.back()(matches_).selected.size()));  // this also warms up
      batch_.push_back(watch.lap_ms() < kShortCall_ms ? kCallsOfShort : 1);
    }
  }

  std::size_t methods() const { return methods_.size(); }
  const std::string& name(std::size_t method) const { return methods_[method]; }
  int selected(std::size_t method) const { return selected_[method]; }

  double time_ms(std::size_t method) const {
    Stopwatch watch;
    for (int call = 0; call < batch_[method]; ++call) calls_[method](matches_);
    return watch.lap_ms() / batch_[method];
  }

 private:
  const CorrespondenceSet& matches_;
  std::vector<std::string> methods_;
  std::vector<GroupFunction> calls_;
  std::vector<int> selected_, batch_;
};

}  // namespace

CorrespondenceSet draw_rows(const CorrespondenceSet& matches, int count, std::uint64_t seed) {
  Indices rows(static_cast<std::size_t>(matches.size()));
  std::iota(rows.begin(), rows.end(), 0);
  RandomStream stream(seed);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    std::swap(rows[i], rows[i + static_cast<std::size_t>(stream.below(rows.size() - i))]);
  rows.resize(static_cast<std::size_t>(count));
  std::sort(rows.begin(), rows.end());
  return select_rows(matches, rows);
}

std::vector<TimeRow> run_time_study(const WorkList& list, const StudySettings& settings,
                                    const std::function<void(const std::string& what)>& observer) {
  const Experiment& experiment = list.experiments.front();
  std::vector<std::size_t> units(list.units.size());
  std::iota(units.begin(), units.end(), 0);
  const InputHashes inputs = hash_inputs(list, units, 1);
  const std::filesystem::path folder(settings.run);
  make_folder(folder.string());
  const FolderLock lock(folder.string());
  check_same_study(folder.string(), identity_of(list));
  const ContentStore store(settings.cache.empty() ? (folder / "cache").string() : settings.cache, settings.cache_limit);
  observer("matching");
  std::vector<StudyRecord> records;
  const auto& levels = experiment.info.levels;
  for (const Table& table : find_tables(list, inputs, store))
    for (std::size_t level = 0; level < levels.size(); ++level) {
      const auto count = static_cast<int>(levels[level].low);
      if (count > table.matches.size()) continue;
      observer(levels[level].label + " matches");
      const std::string& pair = table.unit->pair.name;
      const CorrespondenceSet drawn =
          draw_rows(table.matches, count, derive_seed(experiment.seed, pair + "/" + levels[level].label));
      const Timer timer(*table.unit, drawn);
      for (int repeat = 0; repeat < experiment.repeats; ++repeat)
        for (std::size_t method = 0; method < timer.methods(); ++method) {
          StudyRecord record;
          record.experiment = experiment.info.name, record.dataset = experiment.info.dataset;
          record.level = levels[level].label, record.pair = pair, record.method = timer.name(method);
          record.repeat = repeat, record.value = count, record.status = {MethodState::Timed}, record.matches = count;
          record.selected = timer.selected(method), record.time_ms = timer.time_ms(method);
          records.push_back(std::move(record));
        }
    }
  if (records.empty())
    throw IoError(settings.run, "",
                  "no pair has as many matches as the smallest size, expected smaller levels or a smaller radius_pr of "
                  "its detector");
  const std::vector<TimeRow> rows = time_rows(experiment.info, records);
  const std::vector<UnitResult> results(list.units.size());  // finished; nothing was judged
  write_files({{(folder / "records.csv").string(), records_header() + records_text(records)},
               {(folder / "time.csv").string(), time_text(rows)},
               {(folder / "manifest.json").string(),
                manifest_text(list, inputs, {results, {compact_json(machine_json())}, settings.command_line})}});
  return rows;
}

}  // namespace corral
