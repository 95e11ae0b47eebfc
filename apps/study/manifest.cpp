// SPDX-License-Identifier: MIT
#include "apps/study/manifest.h"

#include <filesystem>
#include <unordered_set>

#include "apps/pair/methods.h"
#include "apps/runtime/build_info.h"
#include "apps/runtime/json.h"
#include "apps/runtime/workers.h"
#include "io/disk/file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

Json to_json(const Experiment& experiment) {
  const ExperimentInfo& info = experiment.info;
  Json levels = Json::array(), foreign = Json::array(), filters = Json::object();
  Json exceptions = Json::object(), options = Json::object();
  for (const StudyLevel& level : info.levels)
    levels.push_back({{"label", level.label}, {"low", level.low}, {"high", level.high}});
  for (const AttributeFilter& filter : experiment.filters) filters[filter.attribute] = filter.values;
  for (const AttributeFilter& filter : experiment.exceptions) exceptions[filter.attribute] = filter.values;
  for (const auto& [name, overrides] : experiment.options)
    if (!look_up(methods(), name)) options[name] = overrides;
  for (const ForeignMethod& method : experiment.foreign)
    foreign.push_back({{"name", method.name},
                       {"title", method.title},
                       {"labels", !method.labels.empty()},
                       {"poses", !method.poses.empty()},
                       {"times", !method.times.empty()},
                       {"time_ms", json_or_null(method.time_ms)},
                       {"command", method.external ? Json(method.external->command) : Json(nullptr)}});
  for (const std::string& method : info.methods) {
    if (!look_up(methods(), method)) continue;
    const auto found = experiment.options.find(method);
    options[method] = corral::to_json(
        find_method(method).configure(found == experiment.options.end() ? OptionOverrides() : found->second).options);
    options[method].erase("seed");  // every call has its own, derived from that of the experiment
  }
  return {{"name", info.name},
          {"title", info.title},
          {"figure", info.figure},
          {"dataset", info.dataset},
          {"attribute", info.attribute},
          {"axis", info.axis},
          {"levels", levels},
          {"methods", info.methods},
          {"foreign_methods", foreign},
          {"threshold_pr", info.threshold_pr},
          {"least_true_matches", info.least_true_matches},
          {"filter", filters},
          {"except", exceptions},
          {"matching", corral::to_json(experiment.matching)},
          {"varied", experiment.varied},
          {"varied_values", experiment.varied_values},
          {"options", options},
          {"repeats", experiment.repeats},
          {"seed", experiment.seed},
          {"dense", experiment.dense},
          {"all_rows", experiment.all_rows},
          {"by_surface", experiment.by_surface},
          {"confidence", experiment.confidence},
          {"tables", experiment.tables}};
}

Json experiments_json(const WorkList& list) {
  Json experiments = Json::array();
  for (const Experiment& experiment : list.experiments) experiments.push_back(to_json(experiment));
  return experiments;
}

/// An object with many entries, each name once: looking a name up in a Json takes as long as it has entries.
class NamedEntries {
 public:
  /// The new entry; null if the name is there already.
  Json* add(const std::string& name) {
    if (!names_.insert(name).second) return nullptr;
    return &entries_.emplace_back(name, Json()).second;
  }
  Json json() { return std::move(entries_); }

 private:
  std::unordered_set<std::string> names_;
  Json::object_t entries_;
};

/// Files by data set and pair, so that the same data in another folder are the same.
Json inputs_json(const WorkList& list, const InputHashes& inputs) {
  NamedEntries pairs;
  for (const WorkUnit& unit : list.units) {
    Json* pair = pairs.add(unit.dataset + "/" + unit.pair.name);
    if (!pair) continue;
    const auto hash = [&](const std::string& file) { return hash_of(inputs, file); };
    *pair = {{"source", hash(unit.pair.source)}, {"target", hash(unit.pair.target)}, {"truth", hash(unit.pair.truth)}};
    if (!unit.pair.matches.empty()) (*pair)["matches"] = hash(unit.pair.matches);
    for (const std::string& truth : unit.pair.equal_truths) (*pair)["equal_truths"].push_back(hash(truth));
    for (const GroupingTask& task : unit.tasks) {
      if (task.answer)
        for (const std::string& file : task.answer->files()) (*pair)["answers"][task.method].push_back(hash(file));
      if (task.external)
        for (const std::string& file : task.external->files()) (*pair)["programs"][task.method].push_back(hash(file));
    }
  }
  return pairs.json();
}

/// A pair that is matched in several ways is described as in the first experiment that uses it.
Json pairs_json(const WorkList& list, const std::vector<UnitResult>& results) {
  NamedEntries pairs;
  const auto absolute = [](const std::string& file) {
    return file.empty() ? file : fs::absolute(file).lexically_normal().string();
  };
  for (const StudySample& sample : list.samples) {
    const auto unit_number = static_cast<std::size_t>(sample.unit);
    const WorkUnit& unit = list.units[unit_number];
    Json* const added = pairs.add(unit.dataset + "/" + unit.pair.name);
    if (!added) continue;
    Json& pair = *added;
    pair = {{"source", absolute(unit.pair.source)},
            {"target", absolute(unit.pair.target)},
            {"truth", absolute(unit.pair.truth)},
            {"resolution", 0}};
    if (!unit.pair.matches.empty()) pair["matches"] = absolute(unit.pair.matches);
    for (const std::string& truth : unit.pair.equal_truths) pair["equal_truths"].push_back(absolute(truth));
    if (unit_number >= results.size()) continue;
    const UnitResult& result = results[unit_number];
    pair["resolution"] = result.resolution;
    if (result.source_points == 0) continue;  // failed, or not looked at
    pair["source_points"] = result.source_points;
    pair["source_keypoints"] = result.source_keypoints;
  }
  return pairs.json();
}

void fill_hashes(InputHashes& inputs, int jobs) {
  std::vector<InputHashes::value_type*> files;
  for (auto& input : inputs) files.push_back(&input);
  workers(jobs)(static_cast<int>(files.size()), [&](int i) {
    auto& [file, hash] = *files[static_cast<std::size_t>(i)];
    try {
      const auto [name, key] = split_transform_name(file);  // a truth may be one of several in its file
      hash = content_hash(read_file(name) + key);
    } catch (const IoError&) {  // the record of the pair reports it
    }
  });
}

}  // namespace

InputHashes hash_inputs(const WorkList& list, const std::vector<std::size_t>& units, int jobs) {
  InputHashes inputs;
  for (const std::size_t unit : units) {
    for (const std::string& file : list.units[unit].files())
      if (!file.empty()) inputs[file];
  }
  fill_hashes(inputs, jobs);
  return inputs;
}

InputHashes hash_answers(const WorkList& list) {
  InputHashes answers;
  for (const WorkUnit& unit : list.units)
    for (const GroupingTask& task : unit.tasks)
      for (const std::string& file : task.foreign_files()) answers[file];
  fill_hashes(answers, 0);
  for (auto answer = answers.begin(); answer != answers.end();)
    answer = answer->second.empty() ? answers.erase(answer) : std::next(answer);
  return answers;
}

StudyIdentity identity_of(const WorkList& list) {
  const BuildInfo build = build_info();
  ContentHasher hasher;  // a large study has a long text
  hasher.add(compact_json(experiments_json(list)));
  for (const WorkUnit& unit : list.units) hasher.add("\n" + unit_text(unit));
  return {build.version, build.commit, hasher.hash()};
}

Json machine_json() {
  const MachineInfo machine = machine_info();
  return {{"processor", machine.processor},
          {"processors", machine.processors},
          {"memory_gb", machine.memory_gb},
          {"system", machine.system}};
}

std::string manifest_text(const WorkList& list, const InputHashes& inputs, const StudyOrigin& origin) {
  const BuildInfo build = build_info();
  Json machines = Json::array();
  for (const std::string& machine : origin.machines) machines.push_back(Json::parse(machine));
  return json_text(Json{{"format", "corral run 2"},
                        {"program",
                         {{"version", build.version},
                          {"commit", build.commit},
                          {"compiler", build.compiler},
                          {"flags", build.flags},
                          {"libraries", build.libraries}}},
                        {"machines", machines},
                        {"command_line", origin.command_line},
                        {"experiments_hash", identity_of(list).experiments},
                        {"experiments", experiments_json(list)},
                        {"pairs", pairs_json(list, origin.results)},
                        {"inputs", inputs_json(list, inputs)}});
}

void check_same_study(const std::string& folder, const StudyIdentity& mine) {
  const std::string path = (fs::path(folder) / "manifest.json").string();
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  StudyIdentity other;
  try {
    const Json manifest = Json::parse(read_file(path));
    other = {manifest.at("program").at("version"), manifest.at("program").at("commit"),
             manifest.at("experiments_hash")};
  } catch (const Json::exception& error) {
    throw IoError(path, "", std::string("is not the manifest of a study: ") + error.what());
  }
  const std::string difference = other.difference_from(mine);
  if (!difference.empty())
    throw IoError(path, "",
                  "this study was made " + difference + ", expected another folder for -o (or remove this one)");
}

}  // namespace corral
