// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "grouping/columns/otsu.h"
#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

enum class VotingForm {
  Paper,     ///< global voters are the best by feature ratio; T(c) is a full rigid motion
  Covis,     ///< global voters are the best by local score, as in the program of [buch2014search]
  Rotation,  ///< as Paper, but T(c) is a rotation about the origin, as [yang2017evaluation] prints it
};
constexpr std::array<const char*, 3> choice_names(VotingForm) { return {"paper", "covis", "rotation"}; }

struct SearchOfInliersOptions {
  int voters = 250;
  double similarity = 0.9;
  double tolerance_pr = 5;
  OtsuRule otsu = OtsuRule::Exact;
  VotingForm form = VotingForm::Paper;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"voters", "", "250", "number of local voters, and of global voters (kappa)", at_least(1)},
          self.voters);
    visit(OptionField{"similarity", "", "0.9", "rigidity ratio above which a voter agrees", within(0, 1)},
          self.similarity);
    visit(OptionField{"tolerance_pr", "pr", "5", "residual of a global voter under T(c)", above(0)}, self.tolerance_pr);
    visit(OptionField{"otsu", "", "", "how the threshold on the score is found"}, self.otsu);
    visit(OptionField{"form", "", "rotation", "paper, covis (Buch's program) or rotation (T(c) as printed)"},
          self.form);
  }
};

/// Search of inliers (SI): local voters check rigidity, global voters check the pose that a match's two frames propose.
///
///   local     C_L(c) = matches that pass the ratio test among the kappa spatial neighbours of c in the source
///             Y_L(c) = { j in C_L : r(c,j) > similarity }
///   global    C_G    = the kappa best matches by 1 - d1/d2 (c itself does not vote)
///             Y_G(c) = { j in C_G : r(c,j) > similarity and |T(c) p_j - p'_j| < tolerance },  T(c) = (L'^T L, p' - L'^T L p)
///   s(c) = (|Y_L| + |Y_G|) / (|C_L| + |C_G|)        selected = { c : s(c) >= Otsu(s) }
///
/// covis     C_G is chosen by the local score |Y_L|/|C_L| (an empty C_L scores 0), both ratios compare with >=, and the
///           ratio test is strict.
/// Source    [buch2014search]; form and values [yang2017evaluation], Table 1.
/// Reads     all columns: points, frames, both feature distances, resolution.
/// Returns   selected, scores.
/// Cost      O(M^2 + M kappa) time, O(M) memory. Deterministic.
/// Throws    InvalidInput: option out of range, column absent, ragged or non-finite.
/// Departs   The paper's T(c) is a rotation alone, which cannot be compared with p'; the full motion is. Ties in distance,
///           ratio or local score go to the lower row. No voters at all: s = 0. A match with an invalid frame gets no
///           global votes, but its C_G counts. Fewer than 3 matches are returned as they are, without scores. The covis
///           form uses the pair's resolution (Buch: the target's), leaves the Otsu rule to its option, and needs d2 (Buch
///           falls back to the median of d1).
GroupingResult group_by_search_of_inliers(const CorrespondenceSet& matches, const SearchOfInliersOptions& options = {});
double working_memory(int matches, const SearchOfInliersOptions& options);

}  // namespace corral
