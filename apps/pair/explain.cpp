// SPDX-License-Identifier: MIT
#include "apps/pair/explain.h"

#include <algorithm>

#include "apps/pair/normal_sides.h"
#include "apps/runtime/text_table.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr int kFewKeypoints = 20;
constexpr int kLeastRows = 3;  ///< that determine a pose
constexpr double kLeastPrecision = 0.5;

std::string pr(double value) { return fixed(value, value < 10 ? 2 : 1) + " pr"; }

/// "ends at 0.08 pr", or why there is no pose.
std::string end_text(const MethodRecord& record) {
  if (!record.pose.target_from_source) return std::string("gives no pose (") + to_text(record.pose.status) + ")";
  if (!record.errors || !record.errors->points) return "gives a pose, but there is no overlap to evaluate it on";
  return "ends at " + pr(record.errors->points->mean_pr);
}

/// "kept 3 of the 30 correct matches among 12 rows (precision 0.250, recall 0.100); their fit is at 7.10 pr"
std::string start_of(const MethodRecord& record) {
  const GroupingScore& score = *record.score;
  std::string text = "kept " + std::to_string(score.correct) + " of the " + std::to_string(score.true_matches) +
                     " correct matches among " + std::to_string(score.selected) + " rows";
  if (score.precision && score.recall)
    text += " (precision " + fixed(score.precision, 3) + ", recall " + fixed(score.recall, 3) + ")";
  if (record.initial_errors && record.initial_errors->points)
    text += "; their fit is at " + pr(record.initial_errors->points->mean_pr);
  return text;
}

std::string dense_of(const MethodRecord& record) {
  if (!record.dense_errors || !record.dense_errors->points) return "";
  std::string text = "; the dense refinement ends at " + pr(record.dense_errors->points->mean_pr);
  if (!is_registered(record.dense_errors)) return text + ", lost";
  return is_registered(record.errors) ? text : text + ", which registers the pair";
}

/// For a grouper that does not register the pair although the oracle does, and whose fit does not either.
Cause cause_of_loss(const PairEnd& method) {
  if (method.correct < kLeastRows) return Cause::GrouperMissed;
  if (method.state == MethodState::DegenerateGeometry) return Cause::DegenerateSelection;
  if (method.precision < kLeastPrecision) return Cause::GrouperMissed;
  if (method.state == MethodState::Diverged) return Cause::Diverged;
  return method.state == MethodState::NotConverged ? Cause::NotConverged : Cause::GrouperMissed;
}

std::string text_of_pair(Cause cause, const PairCounts& counts, const MethodRecord& oracle) {
  const std::string matches = std::to_string(counts.true_matches) + " of " + std::to_string(counts.keypoints) +
                              " matches are correct within " + fixed(counts.threshold_pr, 1) + " pr";
  const std::string keypoints = std::to_string(counts.keypoints_in_overlap) + " of " +
                                std::to_string(counts.keypoints) + " matched source keypoints lie in the overlap";
  const std::string limit =
      "a pair is registered by a mean error over the overlap of at most " + to_text(kSuccessPr) + " pr";
  if (cause == Cause::Found)
    return "can be registered: " + matches + ", and the refinement of all of them " + end_text(oracle) + "; " +
           keypoints + " (" + limit + ")";
  if (cause == Cause::TruthDoesNotFit)
    return "the truth does not fit the surfaces, so no result that is judged by it means anything: " + counts.misfit;
  if (cause == Cause::NormalsOpposed)
    return "lost before the grouping: the normals of the source (" + counts.source_side + ") and of the target (" +
           counts.target_side + ") point to opposite sides on " + fixed(100 * *counts.opposed_share, 0) +
           " % of the overlap, and descriptors of opposite sides do not match: give the place of the sensor with "
           "--sensor, "
           "or turn the faces of one; " +
           matches;
  if (cause == Cause::TooFewKeypoints)
    return "lost before the grouping: " + keypoints + ", and of fewer than " + std::to_string(kFewKeypoints) +
           " not even " + std::to_string(kLeastRows) + " correct matches can be expected (at 15 %); " + matches;
  if (counts.true_matches < kLeastRows)
    return "lost before the grouping: " + matches + ", and a pose needs " + std::to_string(kLeastRows) + "; " +
           keypoints;
  return "lost before the grouping: " + matches + ", but the refinement of all of them " + end_text(oracle) + "; " +
         keypoints + " (" + limit + ")";
}

/// Why the selection does not register a pair that could be registered.
std::string fault_of(const GroupingScore& score) {
  if (score.correct < kLeastRows) return "too few correct matches kept";
  return *score.precision < kLeastPrecision ? "too many incorrect matches kept"
                                            : "the correct matches kept do not determine the pose";
}

std::string text_of_method(Cause cause, const MethodRecord& record) {
  switch (cause) {
    case Cause::NoAnswer:
      return "gave no answer: " + to_text(record.status());
    case Cause::Found:
      return "registered by the fit: " + start_of(record) + ", the refinement " + end_text(record);
    case Cause::Saved:
      return "registered by the refinement: " + start_of(record) + ", above " + to_text(kSuccessPr) +
             " pr, the refinement " + end_text(record);
    case Cause::TruthDoesNotFit:
    case Cause::NormalsOpposed:
    case Cause::TooFewKeypoints:
    case Cause::TooFewTrueMatches:
      return std::string("lost with the pair (") + to_text(cause) + "): " + start_of(record) + ", the refinement " +
             end_text(record);
    case Cause::GrouperMissed:
      return fault_of(*record.score) + ": " + start_of(record) + ", the refinement " + end_text(record);
    case Cause::DegenerateSelection:
      return "the selection determines no pose: " + start_of(record) + ", all on one line or at one point";
    case Cause::Diverged:
      return "the refinement diverged: " + start_of(record) + ", the refinement " + end_text(record);
    case Cause::NotConverged:
      return "the refinement did not converge within " + std::to_string(record.pose.iterations) +
             " iterations: " + start_of(record) + ", the refinement " + end_text(record);
    case Cause::Spoiled:
      break;
  }
  return "lost by the refinement: " + start_of(record) + ", the refinement " + end_text(record);
}

}  // namespace

const char* to_text(Cause cause) {
  switch (cause) {
    case Cause::Found:
      return "found";
    case Cause::Saved:
      return "saved";
    case Cause::TruthDoesNotFit:
      return "truth does not fit";
    case Cause::NormalsOpposed:
      return "normals opposed";
    case Cause::TooFewKeypoints:
      return "too few keypoints";
    case Cause::TooFewTrueMatches:
      return "too few true matches";
    case Cause::GrouperMissed:
      return "grouper missed";
    case Cause::DegenerateSelection:
      return "degenerate selection";
    case Cause::Diverged:
      return "diverged";
    case Cause::NotConverged:
      return "not converged";
    case Cause::Spoiled:
      return "spoiled";
    case Cause::NoAnswer:
      break;
  }
  return "no answer";
}

PairEnd end_of(const MethodRecord& record) {
  PairEnd end{is_registered(record.initial_errors), is_registered(record.errors), record.status().state};
  if (!record.score) return end;
  end.correct = record.score->correct;
  end.precision = record.score->precision.value_or(0);
  return end;
}

Cause cause_of(const PairState& pair) {
  if (!pair.fits) return Cause::TruthDoesNotFit;
  if (pair.is_registered_by_oracle) return Cause::Found;
  if (pair.has_opposed_normals) return Cause::NormalsOpposed;
  const bool has_few = pair.keypoints_in_overlap && *pair.keypoints_in_overlap < kFewKeypoints;
  return has_few ? Cause::TooFewKeypoints : Cause::TooFewTrueMatches;
}

Cause cause_of(const PairEnd& method, Cause pair) {
  if (method.state >= MethodState::TooLarge) return Cause::NoAnswer;
  const bool starts_well = method.is_registered_at_first;
  if (method.is_registered) return starts_well ? Cause::Found : Cause::Saved;
  if (starts_well && method.state == MethodState::Diverged) return Cause::Diverged;
  if (starts_well) return method.state == MethodState::NotConverged ? Cause::NotConverged : Cause::Spoiled;
  return pair == Cause::Found ? cause_of_loss(method) : pair;
}

int keypoints_in_overlap(const CorrespondenceSet& matches, const PairTruth& truth) {
  std::vector<bool> is_in(static_cast<std::size_t>(truth.vertices.rows()));
  Eigen::Index next = 0;  // the overlap are vertices, in their order
  for (Eigen::Index vertex = 0; vertex < truth.vertices.rows() && next < truth.overlap.rows(); ++vertex)
    if (truth.vertices.row(vertex) == truth.overlap.row(next)) is_in[static_cast<std::size_t>(vertex)] = true, ++next;
  return static_cast<int>(std::count_if(matches.source_keypoints.begin(), matches.source_keypoints.end(),
                                        [&](int vertex) { return bool(is_in[static_cast<std::size_t>(vertex)]); }));
}

std::vector<Explanation> explain_pair(const PairCounts& counts, const MethodRecord& oracle,
                                      const std::vector<MethodRecord>& records) {
  const Cause pair = cause_of(PairState{counts.misfit.empty(), is_registered(oracle.errors),
                                        is_opposed(counts.opposed_share), counts.keypoints_in_overlap});
  std::vector<Explanation> explanations{{"pair", pair, text_of_pair(pair, counts, oracle)}};
  for (const MethodRecord& record : records) {
    const Cause cause = cause_of(end_of(record), pair);
    explanations.push_back({record.method, cause, text_of_method(cause, record) + dense_of(record)});
  }
  return explanations;
}

}  // namespace corral
