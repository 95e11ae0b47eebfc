// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "kernel/options.h"
#include "kernel/parallel.h"
#include "kernel/surface/keypoints.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// What a vertex weighs in the scatter of its neighbours.
enum class IssWeights {
  Density,  ///< 1 / number of vertices around it
  None,     ///< 1, and the scatter is a sum instead of a mean: the detector of PCL
};
constexpr std::array<const char*, 2> choice_names(IssWeights) { return {"density", "none"}; }

struct IssOptions {
  double salient_radius_pr = 6;
  double non_max_radius_pr = 4;
  double density_radius_pr = 2;
  double gamma_21 = 0.975;
  double gamma_32 = 0.975;
  int minimum_neighbors = 5;
  IssWeights weights = IssWeights::Density;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"salient_radius_pr", "pr", "", "radius of the scatter matrix", above(0)}, self.salient_radius_pr);
    visit(OptionField{"non_max_radius_pr", "pr", "", "radius of the non-maximum suppression", above(0)},
          self.non_max_radius_pr);
    visit(OptionField{"density_radius_pr", "pr", "",
                      "radius in which vertices are counted for their weight (density only)", above(0)},
          self.density_radius_pr);
    visit(OptionField{"gamma_21", "", "", "upper bound of the second eigenvalue over the first", above(0)},
          self.gamma_21);
    visit(OptionField{"gamma_32", "", "", "upper bound of the third eigenvalue over the second", above(0)},
          self.gamma_32);
    visit(OptionField{"minimum_neighbors", "", "", "vertices within both radii, the keypoint among them", at_least(1)},
          self.minimum_neighbors);
    visit(OptionField{"weights", "", "", "by the number of vertices around (density) or as in PCL (none)"},
          self.weights);
  }
};

/// Intrinsic shape signatures (ISS): vertices whose neighbours spread in three directions, and differently in each.
///
///   w_j = 1 / |{ k : |x_k - x_j| < r_density }|
///   C_i = sum w_j (x_j - x_i) (x_j - x_i)^T / sum w_j  over |x_j - x_i| < r_salient     e1 >= e2 >= e3 its eigenvalues
///   saliency_i = e3 where e2 / e1 < gamma_21 and e3 / e2 < gamma_32, else 0
///
/// A keypoint has the largest saliency of all vertices nearer than r_non_max, and at least `minimum_neighbors` vertices
/// nearer than r_salient and nearer than r_non_max.
///
/// Source    [zhong2009iss], after later descriptions: the paper itself was not at hand. The values of all options but
///           r_density are those of the example in the documentation of PCL's ISSKeypoint3D.
/// Cost      O(V m) time, m vertices within the largest radius; O(V) memory. Any number of threads gives the same bits.
/// Throws    InvalidInput if an option or `resolution` is out of range, or if the largest radius holds over 2000 vertices on
///           average (and over 2e7 in all).
/// Departs   r_density is a choice of ours: 2 pr hold about a dozen vertices. An e3 of at most 1e-9 e1 is flat ground and no
///           saliency. Ties go to the lower index. From PCL 1.13, with `none`: there all vertices of a tie stay; e3 above 0
///           is enough, so that rounding makes keypoints on flat ground; a vertex whose e3 rounding makes negative gets
///           whatever stood in memory; distances are floats. PCL's test for vertices at a border (off unless a radius is
///           given) is not here.
Keypoints detect_iss(const Mesh& mesh, double resolution, const IssOptions& options = {},
                     const ParallelFor& parallel = one_by_one);

/// The saliency of every vertex, V: mesh units squared; with `none` times the number of vertices. Throws as above.
Eigen::VectorXd iss_saliency(const Mesh& mesh, double resolution, const IssOptions& options = {},
                             const ParallelFor& parallel = one_by_one);

}  // namespace corral
