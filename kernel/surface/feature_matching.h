// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "kernel/correspondence_set.h"
#include "kernel/options.h"
#include "kernel/parallel.h"
#include "kernel/surface/descriptors.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// How the nearest features are found.
enum class Matcher { Exact, Flann };
constexpr std::array<const char*, 2> choice_names(Matcher) { return {"exact", "flann"}; }

struct MatchingOptions {
  Matcher matcher = Matcher::Exact;
  bool mutual = false;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"matcher", "", "exact", "flann: approximate, not reproducible, for very many features"},
          self.matcher);
    visit(OptionField{"mutual", "", "false", "keep a match only if each side is the nearest of the other"},
          self.mutual);
  }
};

/// The two nearest target features of source features.
struct FeatureMatches {
  Indices source;                   ///< column of the source features, ascending; all of them unless mutual
  Indices nearest;                  ///< column of the target features
  Eigen::VectorXd distance;         ///< L2 to it
  Eigen::VectorXd second_distance;  ///< L2 to the second nearest, 0 where there is only one target feature
};

/// L2 matching of the columns of D x N and D x M. `exact`: ties go to the lower target column, and any number of threads
/// gives the same bits. `flann` is approximate and **not reproducible**: its trees take their seeds from the system; the
/// distances to what it finds are exact. Nothing is returned if either side is empty.
/// Throws    InvalidInput for a feature that is not finite.
FeatureMatches match_features(const Eigen::MatrixXd& source, const Eigen::MatrixXd& target,
                              const MatchingOptions& options = {}, const ParallelFor& parallel = one_by_one);

/// A described surface.
struct DescribedSurface {
  const Mesh& mesh;
  const Descriptors& descriptors;
};

/// The table of matches of two described surfaces: a row per source keypoint, in their order, with its nearest target
/// keypoint. Several rows may share a target, unless mutual; no match is discarded.
CorrespondenceSet make_correspondences(const DescribedSurface& source, const DescribedSurface& target,
                                       double resolution, const MatchingOptions& options = {},
                                       const ParallelFor& parallel = one_by_one);

}  // namespace corral
