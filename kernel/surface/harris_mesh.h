// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "kernel/options.h"
#include "kernel/surface/keypoints.h"
#include "kernel/surface/mesh/mesh.h"

namespace corral {

/// Which vertices the quadratic of a vertex is fitted to.
enum class MeshNeighborhood { Adaptive, Rings, Ball };
constexpr std::array<const char*, 3> choice_names(MeshNeighborhood) { return {"adaptive", "rings", "ball"}; }

/// Which candidates become keypoints.
enum class MeshSelection { Fraction, Clustering };
constexpr std::array<const char*, 2> choice_names(MeshSelection) { return {"fraction", "clustering"}; }

struct HarrisMeshOptions {
  MeshNeighborhood neighborhood = MeshNeighborhood::Adaptive;
  int rings = 2;
  double radius_pr = 3, extent = 0.01;
  MeshSelection selection = MeshSelection::Fraction;
  double fraction = 0.01, separation = 0.01, k = 0.04;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"neighborhood", "", "", "what the quadratic of a vertex is fitted to"}, self.neighborhood);
    visit(
        OptionField{"rings", "", "", "of rings: edges between a vertex and the rim of its neighbourhood", at_least(1)},
        self.rings);
    visit(OptionField{"radius_pr", "pr", "", "of ball: its radius", above(0)}, self.radius_pr);
    visit(OptionField{"extent", "", "", "of adaptive: share of the bounding-box diagonal", above(0)}, self.extent);
    visit(OptionField{"selection", "", "", "which candidates become keypoints"}, self.selection);
    visit(OptionField{"fraction", "", "", "of fraction: share of the vertices", above_up_to(0, 1)}, self.fraction);
    visit(OptionField{"separation", "", "", "of clustering: share of the bounding-box diagonal", above(0)},
          self.separation);
    visit(OptionField{"k", "", "", "weight of the squared trace", at_least_below(0, 0.25)}, self.k);
  }
};

/// Harris 3D on a mesh: vertices where a quadratic patch fitted to their neighbourhood curves in both directions.
///
///   f(x, y) = p1/2 x^2 + p2 x y + p3/2 y^2 + p4 x + p5 y + p6             least squares over the neighbourhood of v
///   A = p4^2 + s (p1^2 + p2^2)    B = p5^2 + s (p2^2 + p3^2)    C = p4 p5 + s (p1 p2 + p2 p3)    s = sigma^2 = 2
///   response = A B - C^2 - k (A + B)^2
///
/// z is the direction of least variance of the neighbourhood, x = y = 0 at v, and the unit of length is the distance from v
/// of the farthest of its neighbours. Neighbourhoods, with v itself:
///   rings     all vertices at most `rings` edges away.
///   ball      all vertices within `radius_pr` of v, joined to it or not.
///   adaptive  ring by ring until a vertex of the last is more than `extent` of the diagonal away, measured along the
///             shortest of the paths with the fewest edges; that ring is kept.
/// A candidate is a vertex whose response is at least 1e-20 and the largest of its ring of neighbours. Selection:
///   fraction    the `fraction` of V (to the nearest whole number) with the largest responses.
///   clustering  from the largest response down, every candidate farther than `separation` of the diagonal from all
///               that were taken before it.
///
/// Source    [sipiran2011harris].
/// Cost      O(V log V + V m) time, m vertices in a neighbourhood; O(V) memory. Deterministic; the order of the vertices
///           matters only where responses are equal to the last bit.
/// Throws    InvalidInput: no faces, a mesh that is not valid, an option or `resolution` out of range, neighbourhoods of
///           over 2000 vertices on average.
/// Departs   From the program of the authors: B takes p5, not p4; k rings are k, not k + 1; `fraction` never asks for more
///           than there are candidates. From both: lengths are divided by the reach of the neighbourhood, so that sigma has
///           a meaning and the unit of the mesh has none; a vertex that is flat up to rounding, or curves in one direction
///           only (an edge, with a response below 0), is never a candidate; ties go to the lower index. Degenerate and
///           non-manifold triangles connect no vertices.
/// The bounding box is that of the axes, as in both: its diagonal, and with it `adaptive` and `clustering`, changes when a
/// mesh is turned (at most by a factor of sqrt 3). All else stays as it is under rigid motion and change of scale.
///
/// Returns all that were selected, whatever lies around them.
Keypoints detect_harris_mesh(const Mesh& mesh, double resolution, const HarrisMeshOptions& options = {});

/// The response of every vertex, V, without a unit. NaN where there is none: a vertex without triangles, fewer than 6
/// vertices in its neighbourhood, no one direction of least variance (all on one line, say), or places that leave the
/// quadratic open (all on one conic). Throws as above.
Eigen::VectorXd harris_mesh_response(const Mesh& mesh, double resolution, const HarrisMeshOptions& options = {});

/// The selection alone, from responses that were computed before. Throws as above, or for another number of responses than
/// vertices.
Keypoints select_harris_mesh(const Mesh& mesh, const Eigen::VectorXd& response, const HarrisMeshOptions& options = {});

}  // namespace corral
