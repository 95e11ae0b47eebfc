// SPDX-License-Identifier: MIT
#include "apps/dataset/check_dataset.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "apps/dataset/pair_sweep.h"
#include "apps/runtime/text_table.h"
#include "kernel/bounding_box.h"
#include "kernel/number_text.h"
#include "kernel/surface/search/coincidence.h"

namespace corral {
namespace {

constexpr double kOutOfLine = 8;
constexpr double kPowers[] = {10, 100, 1000};

/// What is kept of a pair after its surfaces are released.
struct PairNotes {
  std::vector<Finding> findings;
  bool is_complete = false;
  std::size_t source_content = 0, target_content = 0;
  double source_part = 0, target_part = 0;  // one pr as a share of the diagonal
  Points corners;                           // of the source's bounding box under the truth; none without a truth
  double resolution = 0;
};

/// The coincidence of the pair's surfaces under any motion, measured from the coarser side.
class PairFit {
 public:
  PairFit(const SweptPair& pair, double resolution)
      : pair_(pair), resolution_(resolution), ask_source_(pair.source.resolution >= pair.target.resolution) {}

  Coincidence operator()(const RigidTransform& target_from_source) const {
    const SweptSurface& asked = ask_source_ ? pair_.source : pair_.target;
    const SweptSurface& other = ask_source_ ? pair_.target : pair_.source;
    return coincidence(asked.mesh.vertices, other.mesh.vertices, *other.tree,
                       ask_source_ ? target_from_source : target_from_source.inverse(), resolution_);
  }

 private:
  const SweptPair& pair_;
  double resolution_;
  bool ask_source_;
};

std::string in_words(const Coincidence& fit) {
  if (!fit.median_pr) return "nothing within 2 pr";
  return fixed(100 * fit.share, 1) + " % within 2 pr, median " + fixed(fit.median_pr, 2) + " pr";
}

/// What is wrong with the truth; empty if it fits.
std::string judge_truth(const SweptPair& pair, double resolution) {
  const RigidTransform& truth = *pair.truth;
  const PairFit fit(pair, resolution);
  const Coincidence given = fit(truth), inverted = fit(truth.inverse());
  const std::string both = ": " + in_words(inverted) + "; as given " + in_words(given);
  if (inverted.is_good() && (!given.is_good() || inverted.share > 1.5 * given.share))
    return "the inverse of the truth fits better" + both;
  if (given.is_good()) return "";
  for (const double power : kPowers)
    for (const double factor : {power, 1 / power})
      if (fit({truth.rotation, factor * truth.translation}).is_good())
        return "wrong units: the truth fits if its translation is multiplied by " + to_text(factor);
  return "the truth fits neither as given (" + in_words(given) + ") nor inverted (" + in_words(inverted) + ")";
}

bool is_near(double ratio, double power) { return ratio > 0.75 * power && ratio < 1.34 * power; }

/// Whether two sides have the same size in different units: extents may differ in a cluttered scene, resolutions in a
/// thinned one, but hardly both by the same power of ten.
std::string judge_units(double extent_ratio, double resolution_ratio) {
  for (const double power : kPowers)
    for (const double factor : {power, 1 / power})
      if (is_near(resolution_ratio, factor) && extent_ratio > factor / 3 && extent_ratio < factor * 3)
        return "wrong units: the target's pr is " + fixed(resolution_ratio, 3) + " times the source's, its extent " +
               fixed(extent_ratio, 3) + " times";
  return "";
}

PairNotes look_at(const Dataset& dataset, const SweptPair& swept) {
  PairNotes notes;
  const auto find = [&](const std::string& file, const std::string& problem) {
    if (!problem.empty()) notes.findings.push_back({swept.pair.name, file, problem});
  };
  find(swept.pair.source, swept.source.problem);
  find(swept.pair.target, swept.target.problem);
  find(swept.pair.truth, swept.truth_problem);
  notes.is_complete = swept.is_complete();
  if (!notes.is_complete) return notes;
  const Points &source = swept.source.mesh.vertices, &target = swept.target.mesh.vertices;
  const double source_extent = bounding_box(source).diagonal(), target_extent = bounding_box(target).diagonal();
  notes.source_content = swept.source.content;
  notes.target_content = swept.target.content;
  notes.source_part = swept.source.resolution / source_extent;
  notes.target_part = swept.target.resolution / target_extent;
  notes.resolution = pair_resolution(dataset, swept.source.resolution, swept.target.resolution);
  const std::string units =
      judge_units(target_extent / source_extent, swept.target.resolution / swept.source.resolution);
  find("", units);
  const double ratio = notes.resolution / std::min(swept.source.resolution, swept.target.resolution);
  if (units.empty() && !(ratio <= kOutOfLine && ratio >= 1 / kOutOfLine))
    find("", "unusual pr: " + to_text(notes.resolution) + " for the pair, " + to_text(swept.source.resolution) +
                 " on the source, " + to_text(swept.target.resolution) + " on the target");
  if (!swept.truth) return notes;
  if (units.empty()) find(swept.pair.truth, judge_truth(swept, notes.resolution));
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
