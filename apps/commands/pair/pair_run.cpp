// SPDX-License-Identifier: MIT
#include "apps/commands/pair/pair_run.h"

#include <cmath>
#include <sstream>

#include "apps/commands/command_files.h"
#include "apps/commands/pair/run_report.h"
#include "apps/pair/dense_refinement.h"
#include "apps/pair/normal_sides.h"
#include "apps/pair/portfolio.h"
#include "apps/pair/surface_choice.h"
#include "apps/pair/surface_warnings.h"
#include "apps/pair/table_truth_fit.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/workers.h"
#include "apps/study/plan.h"
#include "io/disk/file.h"
#include "io/matches/matches_file.h"

namespace corral {
namespace {

/// Why the truth does not fit; surfaces in different units come first.
std::string misfit_of(const PairRun& run) {
  const std::string& units = run.pair.report.units;
  return (units.empty() ? "" : units + "; ") + run.fit->text();
}

void explain(PairRun& run) {
  const CorrespondenceSet& matches = run.pair.matches;
  run.counts = {matches.size(), keypoints_in_overlap(matches, *run.truth), *run.true_matches(),
                run.truth->threshold_pr};
  if (!run.fit->belongs()) run.counts.misfit = misfit_of(run);
  run.counts.opposed_share = run.opposed_share;
  run.counts.source_side = to_text(run.pair.report.source.normals);
  run.counts.target_side = to_text(run.pair.report.target.normals);
  run.explanations = explain_pair(run.counts, run.bounds[0], run.records);
}

struct Surfaces {
  Mesh source, target;
};

/// Whether the truth fits, and which matches it makes correct.
void judge_truth(PairRun& run, const RigidTransform& truth, const std::optional<Surfaces>& surfaces,
                 double threshold_pr) {
  const CorrespondenceSet& matches = run.pair.matches;
  if (surfaces) {
    const auto& [source, target] = *surfaces;
    run.truth = pair_truth(source, target, truth, matches.resolution, threshold_pr);
    const auto spacing = [](const PointSpacing& known, const Mesh& mesh) {  // known where the surfaces were matched
      return known.resolution > 0 ? known : point_spacing(mesh.vertices);
    };
    run.fit = fit_truth(source, target, truth, spacing(run.pair.report.source.spacing, source),
                        spacing(run.pair.report.target.spacing, target));
    if (run.fit->belongs()) run.pair.report.units.clear();  // then the sizes are what they are
    if (!run.fit->belongs()) run.pair.report.warnings.push_back("truth does not fit: " + misfit_of(run));
  } else {
    run.truth = table_truth(matches, truth, threshold_pr);
    const TableTruthFit fit = fit_truth(matches, truth);
    if (!fit.text.empty()) run.pair.report.warnings.push_back("truth does not fit: " + fit.text);
  }
  run.labels = label_correct(matches, truth, threshold_pr);
  run.frames = frame_repeatability(matches, truth, run.labels);
}

/// Opposed normals are a likely cause where all correct matches do not register the pair.
void compare_sides(PairRun& run, const Surfaces& surfaces, const MatchSettings& settings) {
  if (!run.fit->belongs() || is_registered(run.bounds[0].errors)) return;
  run.opposed_share = opposed_normals(surfaces.source, surfaces.target, run.truth->target_from_source,
                                      run.pair.matches.resolution, settings);
  if (is_opposed(run.opposed_share)) run.pair.report.warnings.push_back(opposed_warning(*run.opposed_share));
}

/// The options with the poses that a choice by surfaces needs.
OptionsByName keeping_poses(const std::string& name, OptionsByName options) {
  options[name] = with_kept_poses(name, options[name]);
  return options;
}

}  // namespace

std::vector<std::string> method_names(const std::string& text) {
  std::vector<std::string> words, names;
  std::istringstream stream(text + ",");
  for (std::string word; std::getline(stream, word, ',');) {
    if (word.empty()) throw UsageError("--methods " + text + ": expected all, paper, or names such as ss,gc");
    words.push_back(word);
  }
  for (const std::string& name : expand_groupers(words)) {
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw UsageError("--methods: " + name + " occurs twice");
    names.push_back(name);
  }
  return names;
}

std::string call_text(const std::string& method, int matches, int repeat) {
  constexpr double kLong = 10;
  const double seconds =
      repeat * 1e-9 * static_cast<double>(call_nanoseconds(method, static_cast<std::uint64_t>(matches)));
  const std::string text = method + " on " + std::to_string(matches) + " matches";
  return seconds < kLong ? text : text + ", expected to take about " + std::to_string(std::lround(seconds)) + " s";
}

PairRun evaluate(const RunSettings& settings) {
  PairRun run;
  run.methods = with_plugins(method_names(settings.methods));
  const OptionsByName options = parse_set(settings.set);
  for (const std::string& name : run.methods)
    run.groupers.push_back(
        configure_grouper(name, settings.select == kSelect[1] ? keeping_poses(name, options) : options));
  run.externals = external_methods(settings.external);
  for (const ExternalMethod& method : run.externals) run.methods.push_back(method.name);
  keep_inputs({settings.source, settings.target, settings.matches, settings.truth.file},
              files_of_run(settings.output, run.externals));
  std::optional<RigidTransform> truth;
  if (!settings.truth.empty()) truth = read_truth(settings.truth);
  std::optional<Surfaces> surfaces;
  if (!settings.source.empty())
    surfaces = {read_input(settings.source, settings.drop_stray), read_input(settings.target, settings.drop_stray)};
  if (!settings.matches.empty()) run.pair.matches = read_matches(settings.matches);
  if (!settings.output.empty()) {  // before the work, not after it
    make_folder(settings.output);
    check_writable(settings.output + "/run.json");
  }
  Progress progress(match_stages(settings.match) + 1 + static_cast<double>(run.methods.size()) + settings.dense +
                    (settings.select == kSelect[1]) + 1);
  if (settings.matches.empty())
    run.pair = match_pair(surfaces->source, surfaces->target, settings.match,
                          {[&](const std::string& stage) { progress.begin(stage); }});
  run.pair.report.resolution = run.pair.matches.resolution;
  if (truth) {
    progress.begin("overlap");
    judge_truth(run, *truth, surfaces, settings.threshold_pr);
  }
  for (std::size_t i = 0; i < run.groupers.size(); ++i) {
    progress.begin(call_text(run.methods[i], run.pair.matches.size(), settings.repeat));
    if (run.methods[i] == kRegister && surfaces) {
      run.records.push_back(
          evaluate_registration(run.pair.matches, {surfaces->source, surfaces->target, {}, {}}, run.truth));
      continue;
    }
    run.records.push_back(evaluate_method(run.methods[i], run.groupers[i], run.pair.matches, run.truth, settings.repeat,
                                          static_cast<double>(settings.memory_limit)));
  }
  for (const ExternalMethod& method : run.externals) {
    progress.begin(method.name + " on " + std::to_string(run.pair.matches.size()) + " matches");
    run.records.push_back(evaluate_external(method, run.pair.matches, run.truth, settings.repeat));
  }
  if (settings.select == kSelect[1]) {
    progress.begin("choice by the surfaces");
    choose_by_surfaces(run.records, SurfaceChoice(surfaces->source, surfaces->target, workers(settings.match.threads)),
                       run.pair.matches, run.truth);
  }
  progress.begin("confidence");
  run.signals = rate_poses(run.records, run.pair.matches, workers(settings.match.threads));
  if (truth) run.bounds = evaluate_bounds(run.pair.matches, *run.truth);
  if (truth && settings.matches.empty()) compare_sides(run, *surfaces, settings.match);
  if (settings.rows == kRows[1]) {
    refine_all_rows(run.records, run.pair.matches, run.truth);
    refine_all_rows(run.bounds, run.pair.matches, run.truth);
  }
  if (settings.dense) {
    progress.begin("dense refinement");
    DenseRefinement dense(surfaces->source, surfaces->target, run.pair.matches.resolution,
                          workers(settings.match.threads));
    dense.refine(run.records, run.truth);
    dense.refine(run.bounds, run.truth);
  }
  if (settings.explain) explain(run);
  return run;
}

}  // namespace corral
