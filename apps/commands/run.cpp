// SPDX-License-Identifier: MIT
// corral run: two meshes in, every grouper scored by its alignment.
#include <algorithm>
#include <sstream>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/pair/dense_refinement.h"
#include "apps/pair/explain.h"
#include "apps/pair/match_report.h"
#include "apps/pair/normal_sides.h"
#include "apps/pair/report_pair.h"
#include "apps/pair/surface_warnings.h"
#include "apps/pair/truth_fit.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "apps/runtime/workers.h"
#include "io/file.h"
#include "io/group_file.h"
#include "io/matches_file.h"
#include "io/transform_file.h"

namespace corral {
namespace {

struct Settings {
  std::string source, target, methods = "all", output;
  TruthSettings truth;
  double threshold_pr = 4;
  int repeat = 1;
  std::uint64_t memory_limit = 0;
  MatchSettings match;
  std::vector<std::string> set;
  bool drop_stray = false, dense = false, explain = false, json = false, verbose = false;
};

/// "all" or names between commas, each once.
std::vector<std::string> method_names(const std::string& text) {
  std::vector<std::string> names;
  if (text == "all") {
    for (const Grouper& grouper : groupers()) names.push_back(grouper.name);
    return names;
  }
  std::istringstream stream(text + ",");
  for (std::string name; std::getline(stream, name, ',');) {
    if (name.empty()) throw UsageError("--methods " + text + ": expected all, or names such as ss,gc");
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw UsageError("--methods: " + name + " occurs twice");
    names.push_back(name);
  }
  return names;
}

struct PairRun {
  std::vector<std::string> methods;
  std::vector<ConfiguredGrouper> groupers;
  MatchedPair pair;
  std::optional<PairTruth> truth;
  std::vector<MethodRecord> records;
  std::vector<MethodRecord> bounds;          ///< with a truth: the oracle and the baseline
  std::vector<bool> labels;                  ///< with a truth: which matches are correct
  std::optional<FrameRepeatability> frames;  ///< with a truth
  std::optional<TruthFit> fit;               ///< with a truth
  std::optional<double> opposed_share;       ///< of normals, with a truth by which the pair is lost before the grouping
  PairCounts counts;                         ///< with --explain
  std::vector<Explanation> explanations;     ///< with --explain: of the pair, then of each grouper

  std::optional<int> true_matches() const {
    if (!truth) return std::nullopt;
    return static_cast<int>(std::count(labels.begin(), labels.end(), true));
  }
};

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

Json to_json(const PairRun& run, const Settings& settings) {
  Json methods = Json::array(), options = Json::object(), bounds = Json::array();
  for (std::size_t i = 0; i < run.records.size(); ++i) {
    methods.push_back(corral::to_json(run.records[i]));
    if (settings.dense) methods.back().emplace("dense", nullptr);  // where there was no pose to begin with
    options[run.methods[i]] = corral::to_json(run.groupers[i].options);
  }
  for (const MethodRecord& bound : run.bounds) bounds.push_back(corral::to_json(bound));
  Json json = {{"source", settings.source},
               {"target", settings.target},
               {"resolution", run.pair.report.resolution},
               {"matches", run.pair.matches.size()},
               {"true_matches", json_or_null(run.true_matches())},
               {"truth_fit", run.fit ? corral::to_json(*run.fit) : Json(nullptr)},
               {"warnings", warnings_of(run.pair.report)},
               {"frame_repeatability", json_or_null(run.frames ? run.frames->share() : std::nullopt)},
               {"methods", methods},
               {"bounds", run.truth ? bounds : Json(nullptr)},
               {"details",
                {{"matching", corral::to_json(settings.match)},
                 {"drop_stray", settings.drop_stray},
                 {"threshold_pr", settings.threshold_pr},
                 {"overlap_points", run.truth ? Json(run.truth->overlap.rows()) : Json(nullptr)},
                 {"repeat", settings.repeat},
                 {"options", options}}}};
  if (settings.explain) json["explanation"] = explanation_json(run);
  return json;
}

/// The files of one grouper in the folder of a run: selection, refinement, pose.
std::vector<std::string> files_of(const std::string& method) {
  return {"group_" + method + ".csv", "refine_" + method + ".json", "pose_" + method + ".txt"};
}

/// All that a run writes to its folder, or removes as that of an earlier call.
std::vector<std::string> files_of_run(const std::string& folder) {
  std::vector<std::string> files;
  if (folder.empty()) return files;
  for (const char* name : {"matches.csv", "match_report.json", "methods.csv", "run.json", "dense.csv"})
    files.push_back(folder + "/" + name);
  for (const Grouper& grouper : groupers())
    for (const std::string& name : files_of(grouper.name)) files.push_back(folder + "/" + name);
  return files;
}

/// Every intermediate file of the run, all or none; files that an earlier call left of other groupers are removed.
void write_folder(const PairRun& run, const Settings& settings) {
  const std::string folder = settings.output + "/";
  std::vector<FileContent> files{{folder + "matches.csv", matches_text(run.pair.matches)},
                                 {folder + "match_report.json", json_text(corral::to_json(run.pair.report))},
                                 {folder + "methods.csv", methods_csv(run.records)},
                                 {folder + "run.json", json_text(to_json(run, settings))}};
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
  for (const std::string& path : files_of_run(settings.output)) {
    const auto is_new = [&](const FileContent& file) { return file.path == path; };
    if (std::none_of(files.begin(), files.end(), is_new)) remove_file(path);
  }
}

/// Why the truth does not fit; surfaces in different units come first.
std::string misfit_of(const PairRun& run) {
  const std::string& units = run.pair.report.units;
  return (units.empty() ? "" : units + "; ") + run.fit->text();
}

void explain(PairRun& run, const Mesh& target) {
  const CorrespondenceSet& matches = run.pair.matches;
  const Points seen =
      points_in_overlap(matches.source_points, target, run.truth->target_from_source, matches.resolution);
  run.counts = {matches.size(), static_cast<int>(seen.rows()), *run.true_matches(), run.truth->threshold_pr};
  if (!run.fit->belongs()) run.counts.misfit = misfit_of(run);
  run.counts.opposed_share = run.opposed_share;
  run.counts.source_side = to_text(run.pair.report.source.normals);
  run.counts.target_side = to_text(run.pair.report.target.normals);
  run.explanations = explain_pair(run.counts, run.bounds[0], run.records);
}

/// Opposed normals are a likely cause where all correct matches do not register the pair.
void compare_sides(PairRun& run, const Mesh& source, const Mesh& target, const MatchSettings& settings) {
  if (!run.fit->belongs() || is_registered(run.bounds[0].errors)) return;
  run.opposed_share =
      opposed_normals(source, target, run.truth->target_from_source, run.pair.report.resolution, settings);
  if (is_opposed(run.opposed_share)) run.pair.report.warnings.push_back(opposed_warning(*run.opposed_share));
}

PairRun evaluate(const Settings& settings) {
  PairRun run;
  run.methods = method_names(settings.methods);
  const OptionsByName options = parse_set(settings.set);
  for (const std::string& name : run.methods) run.groupers.push_back(configure_grouper(name, options));
  keep_inputs({settings.source, settings.target, settings.truth.file}, files_of_run(settings.output));
  if (!settings.truth.empty()) run.truth = PairTruth{read_truth(settings.truth), {}, settings.threshold_pr};
  const Mesh source = read_input(settings.source, settings.drop_stray);
  const Mesh target = read_input(settings.target, settings.drop_stray);
  if (!settings.output.empty()) {  // before the work, not after it
    make_folder(settings.output);
    check_writable(settings.output + "/run.json");
  }
  Progress progress(match_stages(settings.match) + 1 + static_cast<double>(run.methods.size()) + settings.dense);
  run.pair = match_pair(source, target, settings.match, {[&](const std::string& stage) { progress.begin(stage); }});
  if (run.truth) {
    progress.begin("overlap");
    run.truth =
        pair_truth(source, target, run.truth->target_from_source, run.pair.report.resolution, settings.threshold_pr);
    const MatchReport& report = run.pair.report;
    run.fit = fit_truth(source, target, run.truth->target_from_source, report.source.spacing, report.target.spacing);
    if (run.fit->belongs()) run.pair.report.units.clear();  // then the sizes are what they are
    if (!run.fit->belongs()) run.pair.report.warnings.push_back("truth does not fit: " + misfit_of(run));
    run.labels = label_correct(run.pair.matches, run.truth->target_from_source, run.truth->threshold_pr);
    run.frames = frame_repeatability(run.pair.matches, run.truth->target_from_source, run.labels);
  }
  for (std::size_t i = 0; i < run.methods.size(); ++i) {
    progress.begin(run.methods[i]);
    run.records.push_back(evaluate_method(run.methods[i], run.groupers[i], run.pair.matches, run.truth, settings.repeat,
                                          static_cast<double>(settings.memory_limit)));
  }
  if (run.truth) {
    run.bounds = evaluate_bounds(run.pair.matches, *run.truth);
    compare_sides(run, source, target, settings.match);
  }
  if (settings.dense) {
    progress.begin("dense refinement");
    DenseRefinement dense(source, target, run.pair.report.resolution, workers(settings.match.threads));
    dense.refine(run.records, run.truth);
    dense.refine(run.bounds, run.truth);
  }
  if (settings.explain) explain(run, target);
  return run;
}

std::string heading(const PairRun& run, const Settings& settings) {
  std::string text =
      settings.source + " -> " + settings.target + ": " + std::to_string(run.pair.matches.size()) + " matches";
  if (const auto correct = run.true_matches())
    text += ", " + std::to_string(*correct) + " correct within " + fixed(settings.threshold_pr, 1) + " pr; overlap " +
            std::to_string(run.truth->overlap.rows()) + " of " + std::to_string(run.pair.report.source.points) +
            " points";
  if (run.frames && run.frames->compared > 0)
    text += "; frames of " + fixed(100 * *run.frames->share(), 1) + " % of the correct matches agree within 10 degrees";
  return text + "\n";
}

/// The tables, and below them what they mean.
std::string in_words(const PairRun& run, const Settings& settings) {
  std::string text = heading(run, settings) + methods_text(run.records, run.bounds);
  if (settings.dense) text += "\ndense refinement, points to planes:\n" + dense_text(run.records, run.bounds);
  if (settings.explain) text += "\n";
  for (const Explanation& explanation : run.explanations) text += explanation.method + ": " + explanation.text + ".\n";
  return text;
}

int run_pair(Settings settings) {
  const OptionsByName options = parse_set(settings.set);
  std::vector<std::string> in_use = settings.match.in_use();
  for (const std::string& name : method_names(settings.methods)) in_use.push_back(name);
  require_in_use(options, in_use);
  settings.match.options = surface_part(options);
  check_usage(settings.match);
  settings.match.inspect = settings.verbose;
  check_threshold(settings.threshold_pr);
  if (settings.repeat < 1) throw UsageError("--repeat: expected at least 1");
  if (settings.explain && settings.truth.empty()) throw UsageError("--explain: needs --truth");
  const PairRun run = evaluate(settings);
  if (settings.verbose)
    say(stage_report(run.pair.report));
  else
    for (const std::string& line : advice(run.pair.report)) say(line);
  if (!settings.output.empty()) write_folder(run, settings);
  if (settings.json)
    put("", to_json(run, settings));
  else
    put("", in_words(run, settings));
  const bool failed =
      std::any_of(run.records.begin(), run.records.end(), [](const auto& record) { return !record.failure.empty(); });
  return failed ? kPartial : kOk;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("run", "Everything on one pair: match, group, score and refine with every grouper");
  auto settings = std::make_shared<Settings>();
  command->add_option("source", settings->source, "Source mesh (a model)")->type_name("FILE")->required();
  command->add_option("target", settings->target, "Target mesh (a scene)")->type_name("FILE")->required();
  add_truth_options(*command, settings->truth, ": adds scores and errors");
  command->add_option("--methods", settings->methods, "all, or names between commas: " + names_of(groupers(), ","))
      ->capture_default_str();
  command->add_option("-o,--output", settings->output, "Folder for every intermediate file")->type_name("FOLDER");
  command->add_option("--threshold-pr", settings->threshold_pr, "Residual up to which a match is correct")
      ->capture_default_str();
  command->add_option("--repeat", settings->repeat, "Timed calls of each grouper; the median is reported")
      ->capture_default_str();
  command->add_flag("--dense", settings->dense,
                    "Also refine every pose on the whole surfaces, reported in a table of its own");
  command->add_flag(
      "--explain", settings->explain,
      "Explain in words where the pair was registered or lost, before the grouping and by each grouper; needs --truth");
  add_memory_limit(*command, settings->memory_limit);
  command->add_flag("--json", settings->json, "As JSON; null where something is undefined");
  command->add_flag("-v,--verbose", settings->verbose, "The stage report on standard error");
  add_match_options(*command, settings->match);
  add_drop_stray(*command, settings->drop_stray);
  add_set_option(*command, settings->set);
  command->footer(
      "With a truth, the row 'oracle' (all correct matches) shows the result of a perfect grouper, and 'baseline' "
      "(all\n"
      "matches) that of no grouper. A pose registers the pair if its mean error over the overlap is at most 5 pr; the\n"
      "outcome is 'found' if both the fit to the selection and the refined pose do, 'saved' if only the refined pose\n"
      "does, 'spoiled' if only the fit does, else 'lost'. ADD is the mean error over the whole source, as a share of\n"
      "its diameter.\n"
      "Examples:\n  corral run model.ply scene.ply --truth truth.txt --explain\n"
      "  corral run model.ply scene.ply --methods ransac,gc --set ransac.iterations=50000 -o results --json");
  command->callback([settings, &action] { action = [settings] { return run_pair(*settings); }; });
}

}  // namespace corral
