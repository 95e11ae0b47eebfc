// SPDX-License-Identifier: MIT
// simulate_shards STUDY PAIRS SHARDS FOLDER: a study of so many pairs that nobody ran, to measure what 'corral plan' and 'corral
// merge' take. FOLDER/data names the files of the given study's first data set again and again under new names, FOLDER/study has
// the journals of its shards, with the results of the given study, and empty files of selections.
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>

#include "apps/study/finished_units.h"
#include "apps/study/manifest.h"
#include "apps/study/plan.h"
#include "apps/study/study_journals.h"
#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

/// The entries of a study by the name of their pair.
std::map<std::string, JournalEntry> entries_of(const StudyJournals& study, const WorkList& list) {
  std::map<std::string, std::string> pair_of;
  for (const WorkUnit& unit : list.units) pair_of[unit_key(unit)] = unit.pair.name;
  std::map<std::string, JournalEntry> entries;
  for (const JournalFile& journal : study.files) {
    JournalReader reader(journal.path);
    while (auto entry = reader.next()) entries[pair_of.at(entry->unit)] = std::move(*entry);
  }
  return entries;
}

/// The pairs of the data set with absolute paths, as often as it takes, each under a name of its own.
Dataset repeated(const Dataset& dataset, int pairs) {
  Dataset many = dataset;
  many.pairs.clear();
  for (int i = 0; i < pairs; ++i) {
    const DatasetPair& pair = dataset.pairs[static_cast<std::size_t>(i) % dataset.pairs.size()];
    DatasetPair copy = dataset.with_paths(pair);
    for (std::string* file : {&copy.source, &copy.target, &copy.truth})
      if (!file->empty()) *file = fs::absolute(*file).string();
    copy.name = pair.name + "+" + std::to_string(i);
    many.pairs.push_back(std::move(copy));
  }
  return many;
}

void simulate(const std::string& from, int pairs, int shards, const std::string& folder) {
  const StudyJournals study = find_study(from);
  const WorkList known = work_list_of(study);
  const auto entries = entries_of(study, known);
  const Dataset many = repeated(read_dataset(study.call.data), pairs);
  const std::string data = folder + "/data", run = folder + "/study";
  make_folder(data);
  write_files({{data + "/dataset.toml", dataset_toml_text(many)}, {data + "/pairs.csv", pairs_csv_text(many)}});
  StudyCall call = study.call;
  call.data = data;
  const WorkList list = work_list_of(call);
  const std::vector<int> shard_of = split_units(estimate_units(list), shards);
  const StudyIdentity identity = identity_of(list);
  std::map<int, JournalWriter> writers;
  for (std::size_t i = 0; i < list.units.size(); ++i) {
    const WorkUnit& unit = list.units[i];
    JournalEntry entry = entries.at(unit.pair.name.substr(0, unit.pair.name.find('+')));
    entry.unit = unit_key(unit);
    for (const auto& [file, shown] : unit.selections) {
      const fs::path path = fs::path(run) / file;
      fs::create_directories(path.parent_path());
      std::fclose(std::fopen(path.c_str(), "w"));
    }
    const Shard shard{shard_of[i], shards};
    writers.try_emplace(shard.number, run, JournalHeader{identity, shard, call, "simulated", machine_json()})
        .first->second.append(entry);
  }
}

}  // namespace
}  // namespace corral

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: simulate_shards STUDY PAIRS SHARDS FOLDER\n";
    return 2;
  }
  try {
    corral::simulate(argv[1], std::atoi(argv[2]), std::atoi(argv[3]), argv[4]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
