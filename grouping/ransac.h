// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "grouping/grouper.h"
#include "grouping/pose/pose_score.h"
#include "kernel/options.h"

namespace corral {

/// How the three matches of a triple are drawn.
enum class TripleSampling {
  Uniform,
  Prosac,      ///< from the most distinctive matches first
  Compatible,  ///< such that each keeps its distance to the others, if ten draws find one
};
constexpr std::array<const char*, 3> choice_names(TripleSampling) { return {"uniform", "prosac", "compatible"}; }

struct RansacOptions {
  int iterations = 10000;
  double tolerance_pr = 5;
  std::uint64_t seed = 1;
  double confidence = 0;
  TripleSampling sampling = TripleSampling::Uniform;
  double edge_similarity = 0;
  PoseScore score = PoseScore::Inliers;
  int local_rounds = 0;
  int keep = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"iterations", "", "10000", "random triples tried", at_least(1)}, self.iterations);
    visit(OptionField{"tolerance_pr", "pr", "5", "residual below which a match agrees with a pose", above(0)},
          self.tolerance_pr);
    visit(OptionField{"seed", "", "", "start of the random stream", at_least(0)}, self.seed);
    visit(OptionField{"confidence", "", "0", "stop once a triple of correct matches is this probable; 0: never",
                      within(0, 1)},
          self.confidence);
    visit(OptionField{"sampling", "", "uniform", "how a triple is drawn"}, self.sampling);
    visit(OptionField{"edge_similarity", "", "0",
                      "rigidity ratio that each edge of a triple must reach; 0: not checked", within(0, 1)},
          self.edge_similarity);
    visit(OptionField{"score", "", "inliers", "what makes a pose the best"}, self.score);
    visit(OptionField{"local_rounds", "", "0", "rounds of fits to the matches in agreement, from each new best pose",
                      within(0, 1000)},
          self.local_rounds);
    visit(OptionField{"keep", "", "0", "poses returned beside the chosen one", at_least(0)}, self.keep);
  }
};

/// Random sample consensus (RANSAC): the matches that agree with the best pose of many random triples.
///
///   e(c, T) = |T p - p'|        T* = argmax_T score(T)        selected = { c : e(c, T*) < tolerance }
///
/// The paper's score is the number of matches in agreement, | { c : e(c, T) < tolerance } |; see PoseScore for others.
///
/// prosac           matches by 1 - d1/d2 in descending order: the draw at iteration t is from the first n(t), which grow so that
///                  after all iterations they are drawn as often as uniformly.
/// compatible       the second and third match are drawn again, up to ten times, until their distances to those before
///                  differ on the two sides by less than the tolerance.
/// edge_similarity  a triple with a rigidity ratio below it is dropped before it is counted.
/// local_rounds     see refit().
/// confidence       stops before iteration k if (1 - w^3)^k <= 1 - confidence, w the share of matches in agreement with T*.
/// Source    [fischler1981random]; form and values [yang2017evaluation], Table 1. The stages: [chum2005prosac],
///           [chum2003locally]; edge lengths as in Open3D.
/// Reads     source_points, target_points, resolution; prosac: both feature distances.
/// Returns   selected, and the pose T* of the winning triple (refitted by local_rounds only); runners-up if asked for.
/// Cost      O(iterations * M) time, O(M) memory (keep, fs: and the poses of all triples). Deterministic for a seed. A triple that
///           cannot win any more is dropped before all of its residuals are known (see filter.h); the winner is that of
///           the plain loop.
/// Throws    InvalidInput: option out of range, column absent, ragged or non-finite.
/// Departs   A triple whose area is at most 1e-3 pr^2 on either side gives no pose but counts as an iteration (the paper does
///           not say). The first triple with the largest score wins. Fewer than 3 matches, or no triple with a match in
///           agreement: nothing selected, no pose.
GroupingResult group_by_ransac(const CorrespondenceSet& matches, const RansacOptions& options = {});
double working_memory(int matches, const RansacOptions& options);

}  // namespace corral
