// SPDX-License-Identifier: MIT
#include "apps/dataset/check_dataset.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "apps/dataset/pair_sweep.h"
#include "apps/pair/surface_warnings.h"
#include "apps/pair/table_truth_fit.h"
#include "apps/pair/truth_fit.h"
#include "apps/runtime/text_table.h"
#include "io/matches/matches_file.h"
#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr double kOutOfLine = 8;

/// What is kept of a pair after its surfaces are released.
struct PairNotes {
  std::vector<Finding> findings;
  bool is_complete = false;
  std::size_t source_content = 0, target_content = 0;
  double source_part = 0, target_part = 0;  // one pr as a share of the diagonal
  Points corners;                           // of the source's bounding box under the truth; none without a truth
  double resolution = 0;
};

/// By the spacing that lone vertices do not move.
TruthFit fit_of(const SweptPair& pair) {
  const double source = pair.source.spacing.without_strays, target = pair.target.spacing.without_strays;
  const SweptSurface &coarse = source >= target ? pair.source : pair.target,
                     &fine = source >= target ? pair.target : pair.source;
  return fit_truth(coarse.mesh.vertices, fine.mesh.vertices, *fine.tree,
                   source >= target ? *pair.truth : pair.truth->inverse(), (source + target) / 2);
}

/// The table of a pair, and of one without surfaces its truth too.
void check_table(const Dataset& dataset, const SweptPair& swept, std::vector<Finding>& findings) {
  const std::string path = dataset.path(swept.pair.matches);
  try {
    const CorrespondenceSet matches = read_matches(path);
    if (!swept.truth) return;
    const TableTruthFit fit = fit_truth(matches, *swept.truth);
    if (!fit.text.empty()) findings.push_back({swept.pair.name, swept.pair.truth, fit.text});
    if (fit.name.empty())
      findings.push_back({swept.pair.name, swept.pair.matches,
                          "fewer than 3 of " + std::to_string(matches.size()) + " matches are correct within 4 pr",
                          false});
  } catch (const IoError& error) {
    findings.push_back({swept.pair.name, swept.pair.matches, without_path(error.what(), path)});
  }
}

PairNotes look_at(const Dataset& dataset, const SweptPair& swept) {
  PairNotes notes;
  const auto find = [&](const std::string& file, const std::string& problem, bool is_error = true) {
    if (!problem.empty()) notes.findings.push_back({swept.pair.name, file, problem, is_error});
  };
  find(swept.pair.source, swept.source.problem);
  find(swept.pair.target, swept.target.problem);
  find(swept.pair.truth, swept.truth_problem);
  if (!swept.pair.matches.empty()) check_table(dataset, swept, notes.findings);
  notes.is_complete = swept.is_complete();
  if (!notes.is_complete) return notes;
  for (const auto& [file, side] : {std::pair{&swept.pair.source, &swept.source}, {&swept.pair.target, &swept.target}}) {
    for (const std::string& note : side->mesh.notes) find(*file, note, false);
    for (const std::string& warning : surface_warnings(side->mesh, side->spacing)) find(*file, warning);
  }
  for (const std::string& note : swept.truth_notes) find(swept.pair.truth, note, false);
  const Points &source = swept.source.mesh.vertices, &target = swept.target.mesh.vertices;
  const double source_extent = bounding_box(source).diagonal(), target_extent = bounding_box(target).diagonal();
  notes.source_content = swept.source.content;
  notes.target_content = swept.target.content;
  notes.source_part = swept.source.resolution / source_extent;
  notes.target_part = swept.target.resolution / target_extent;
  notes.resolution = pair_resolution(dataset, swept.source.resolution, swept.target.resolution);
  const std::optional<TruthFit> fit = swept.truth ? std::optional(fit_of(swept)) : std::nullopt;
  std::string units;
  if (!fit || !fit->belongs())
    units = unit_warning(size_of(source, swept.source.resolution), size_of(target, swept.target.resolution));
  find("", units);
  const double ratio = notes.resolution / std::min(swept.source.resolution, swept.target.resolution);
  if (units.empty() && !(ratio <= kOutOfLine && ratio >= 1 / kOutOfLine))
    find("", "unusual pr: " + to_text(notes.resolution) + " for the pair, " + to_text(swept.source.resolution) +
                 " on the source, " + to_text(swept.target.resolution) + " on the target");
  if (!swept.truth) return notes;
  if (units.empty()) find(swept.pair.truth, fit->text(), !fit->belongs());
  notes.corners.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis)
      notes.corners(i, axis) = (i >> axis) & 1 ? source.col(axis).maxCoeff() : source.col(axis).minCoeff();
  notes.corners = swept.truth->apply(notes.corners);
  return notes;
}

/// Meshes whose pr is an unusual share of their diagonal, among those on the same side.
void compare_resolutions(const Dataset& dataset, std::vector<PairNotes>& notes, bool of_source) {
  std::map<std::string, double> parts;  // by file: a model of many pairs counts once
  const auto file = [&](std::size_t i) { return of_source ? dataset.pairs[i].source : dataset.pairs[i].target; };
  for (std::size_t i = 0; i < notes.size(); ++i)
    if (notes[i].is_complete) parts[file(i)] = of_source ? notes[i].source_part : notes[i].target_part;
  if (parts.size() < 3) return;  // too few to compare with
  std::vector<double> sorted;
  for (const auto& each : parts) sorted.push_back(each.second);
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < notes.size(); ++i) {
    if (!notes[i].is_complete) continue;
    const double ratio = parts[file(i)] / usual;
    if (!(ratio <= kOutOfLine && ratio >= 1 / kOutOfLine))
      notes[i].findings.push_back(
          {dataset.pairs[i].name, file(i),
           "unusual pr: its share of the diagonal is " + fixed(ratio, 3) + " times that of the others"});
  }
}

bool same_pair(const PairNotes& a, const PairNotes& b) {
  if (a.source_content != b.source_content || a.target_content != b.target_content) return false;
  if (a.corners.rows() != b.corners.rows()) return false;
  return a.corners.rows() == 0 || (a.corners - b.corners).rowwise().norm().maxCoeff() < a.resolution;
}

void compare_pairs(const Dataset& dataset, std::vector<PairNotes>& notes) {
  std::multimap<std::pair<std::size_t, std::size_t>, std::size_t> seen;
  for (std::size_t i = 0; i < notes.size(); ++i) {
    if (!notes[i].is_complete) continue;
    const auto key = std::make_pair(notes[i].source_content, notes[i].target_content);
    const auto [first, last] = seen.equal_range(key);
    const auto same =
        std::find_if(first, last, [&](const auto& other) { return same_pair(notes[i], notes[other.second]); });
    if (same != last)
      notes[i].findings.push_back({dataset.pairs[i].name, "",
                                   "duplicate pair: same surfaces and truth as " + dataset.pairs[same->second].name});
    seen.emplace(key, i);
  }
}

/// The words before the numbers.
std::string kind(const Finding& finding) { return finding.problem.substr(0, finding.problem.find_first_of(":(")); }

}  // namespace

std::vector<Finding> check_dataset(const Dataset& dataset, const ParallelFor& parallel, Progress& progress) {
  std::vector<PairNotes> notes(dataset.pairs.size());
  sweep_pairs(dataset, parallel, progress,
              [&](int i, const SweptPair& pair) { notes[static_cast<std::size_t>(i)] = look_at(dataset, pair); });
  compare_resolutions(dataset, notes, true);
  compare_resolutions(dataset, notes, false);
  compare_pairs(dataset, notes);
  std::vector<Finding> findings;
  std::set<std::pair<std::string, std::string>> named;
  for (const PairNotes& each : notes)
    for (const Finding& finding : each.findings)
      if (finding.file.empty() || named.emplace(finding.file, kind(finding)).second) findings.push_back(finding);
  return findings;
}

}  // namespace corral
