// SPDX-License-Identifier: MIT
#include "apps/commands/pair/run_report.h"

#include "apps/pair/confidence_file.h"
#include "apps/pair/confidence_words.h"
#include "apps/pair/match_report.h"
#include "apps/pair/methods.h"
#include "apps/pair/report_pair.h"
#include "apps/runtime/text_table.h"
#include "io/disk/file.h"
#include "io/matches/group_file.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"

namespace corral {
namespace {

Json explanation_json(const PairRun& run) {
  Json methods = Json::array();
  for (std::size_t i = 1; i < run.explanations.size(); ++i) {
    const Explanation& method = run.explanations[i];
    methods.push_back({{"method", method.method}, {"cause", to_text(method.cause)}, {"text", method.text}});
  }
  return {{"success_pr", kSuccessPr},
          {"keypoints_in_overlap", run.counts.keypoints_in_overlap},
          {"cause", to_text(run.explanations[0].cause)},
          {"text", run.explanations[0].text},
          {"methods", methods}};
}

/// The files of one grouper in the folder of a run: selection, refinement, pose.
std::vector<std::string> files_of(const std::string& method) {
  return {"group_" + method + ".csv", "refine_" + method + ".json", "pose_" + method + ".txt"};
}

/// The record with the most probable pose, the first of several; nothing if none has a pose.
std::optional<std::size_t> most_probable(const PairRun& run) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < run.records.size(); ++i)
    if (run.records[i].confidence && !(best && *run.records[*best].confidence >= *run.records[i].confidence)) best = i;
  return best;
}

std::string heading(const PairRun& run, const RunSettings& settings) {
  const std::string pair = settings.matches.empty() ? settings.source + " -> " + settings.target : settings.matches;
  std::string text = pair + ": " + std::to_string(run.pair.matches.size()) + " matches";
  if (const auto correct = run.true_matches())
    text += ", " + std::to_string(*correct) + " correct within " + fixed(settings.threshold_pr, 1) + " pr";
  if (run.fit)
    text += "; overlap " + std::to_string(run.truth->overlap.rows()) + " of " +
            std::to_string(run.truth->vertices.rows()) + " points";
  if (run.frames && run.frames->compared > 0)
    text += "; frames of " + fixed(100 * *run.frames->share(), 1) + " % of the correct matches agree within 10 degrees";
  return text + "\n";
}

}  // namespace

Json to_json(const PairRun& run, const RunSettings& settings) {
  Json methods = Json::array(), options = Json::object(), bounds = Json::array();
  for (std::size_t i = 0; i < run.records.size(); ++i) {
    methods.push_back(corral::to_json(run.records[i]));
    if (settings.dense) methods.back().emplace("dense", nullptr);  // where there was no pose to begin with
    const bool is_external = i >= run.groupers.size();
    options[run.methods[i]] =
        corral::to_json(is_external ? run.externals[i - run.groupers.size()].options() : run.groupers[i].options);
  }
  for (const MethodRecord& bound : run.bounds) bounds.push_back(corral::to_json(bound));
  const std::optional<std::size_t> best = most_probable(run);
  const auto name = [](const std::string& file) { return file.empty() ? Json(nullptr) : Json(file); };
  Json json = {{"source", name(settings.source)},
               {"target", name(settings.target)},
               {"matches_file", name(settings.matches)},
               {"resolution", run.pair.report.resolution},
               {"matches", run.pair.matches.size()},
               {"true_matches", json_or_null(run.true_matches())},
               {"truth_fit", run.fit ? corral::to_json(*run.fit) : Json(nullptr)},
               {"warnings", warnings_of(run.pair.report)},
               {"frame_repeatability", json_or_null(run.frames ? run.frames->share() : std::nullopt)},
               {"methods", methods},
               {"bounds", run.truth ? bounds : Json(nullptr)},
               {"best", best ? Json({{"method", run.records[*best].method},
                                     {"confidence", *run.records[*best].confidence},
                                     {"verdict", verdict(*run.records[*best].confidence)}})
                             : Json(nullptr)},
               {"details",
                {{"matching", settings.matches.empty() ? corral::to_json(settings.match) : Json(nullptr)},
                 {"drop_stray", settings.drop_stray},
                 {"threshold_pr", settings.threshold_pr},
                 {"overlap_points", run.truth ? Json(run.truth->overlap.rows()) : Json(nullptr)},
                 {"repeat", settings.repeat},
                 {"rows", settings.rows},
                 {"select", settings.select},
                 {"options", options}}}};
  if (settings.explain) json["explanation"] = explanation_json(run);
  return json;
}

std::vector<std::string> files_of_run(const std::string& folder, const std::vector<ExternalMethod>& externals) {
  std::vector<std::string> files;
  if (folder.empty()) return files;
  for (const char* name : {"matches.csv", "match_report.json", "methods.csv", "run.json", "dense.csv"})
    files.push_back(folder + "/" + name);
  for (const Grouper& grouper : methods())
    for (const std::string& name : files_of(grouper.name)) files.push_back(folder + "/" + name);
  for (const ExternalMethod& method : externals)
    for (const std::string& name : files_of(method.name)) files.push_back(folder + "/" + name);
  return files;
}

void write_folder(const PairRun& run, const RunSettings& settings) {
  const std::string folder = settings.output + "/";
  std::vector<FileContent> files{{folder + "matches.csv", matches_text(run.pair.matches)},
                                 {folder + "methods.csv", methods_csv(run.records)},
                                 {folder + "run.json", json_text(to_json(run, settings))}};
  if (settings.matches.empty())
    files.push_back({folder + "match_report.json", json_text(corral::to_json(run.pair.report))});
  if (settings.dense) files.push_back({folder + "dense.csv", dense_csv(run.records)});
  for (const MethodRecord& record : run.records) {
    if (!record.failure.empty()) continue;
    const std::vector<std::string> names = files_of(record.method);
    files.push_back(
        {folder + names[0], group_text({run.pair.matches.size(), record.found.selected, record.found.scores})});
    files.push_back({folder + names[1], json_text(pose_json(record))});
    if (record.pose.target_from_source)
      files.push_back({folder + names[2], transform_text(*record.pose.target_from_source)});
  }
  write_files(files);
  for (const std::string& path : files_of_run(settings.output, run.externals)) {
    const auto is_new = [&](const FileContent& file) { return file.path == path; };
    if (std::none_of(files.begin(), files.end(), is_new)) remove_file(path);
  }
}

std::string in_words(const PairRun& run, const RunSettings& settings) {
  std::string text = heading(run, settings) + methods_text(run.records, run.bounds);
  if (settings.rows == kRows[1])
    text += "\nrefined over all matches, from there:\n" + all_rows_text(run.records, run.bounds);
  if (settings.dense) text += "\ndense refinement, points to planes:\n" + dense_text(run.records, run.bounds);
  if (run.truth && !run.fit)
    text += "Errors are over the source points of the correct matches, the RMSE over those of all matches.\n";
  if (const std::optional<std::size_t> best = most_probable(run)) {
    const MethodRecord& record = run.records[*best];
    text += "best pose: " + record.method + "; " +
            (run.signals[*best] ? confidence_words(built_in_confidence().table, *run.signals[*best])
                                : verdict(*record.confidence) + (": probability " + fixed(*record.confidence, 3))) +
            "\n";
  }
  if (settings.explain) text += "\n";
  for (const Explanation& explanation : run.explanations) text += explanation.method + ": " + explanation.text + ".\n";
  return text;
}

}  // namespace corral
