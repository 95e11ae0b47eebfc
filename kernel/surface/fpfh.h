// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "kernel/options.h"
#include "kernel/parallel.h"
#include "kernel/surface/descriptors.h"

namespace corral {

/// Length of an FPFH descriptor: 11 bins for each of three angles.
constexpr int kFpfhSize = 33;

/// How the histograms around a keypoint are put together.
enum class FpfhForm {
  Paper,  ///< its own, and those of its neighbours by 1 / distance
  Pcl,    ///< those of its neighbours alone, by 1 / distance squared
};
constexpr std::array<const char*, 2> choice_names(FpfhForm) { return {"paper", "pcl"}; }

struct FpfhOptions {
  double radius_pr = 15;
  int minimum_support = 10;
  FpfhForm form = FpfhForm::Paper;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"radius_pr", "pr", "", "radius of the support; what is read reaches twice as far", above(0)},
          self.radius_pr);
    visit(OptionField{"minimum_support", "", "", "vertices other than the keypoint that the support must hold",
                      at_least(0)},
          self.minimum_support);
    visit(OptionField{"form", "", "", "histograms weighted as in the paper or as in PCL (pcl)"}, self.form);
  }
};

/// Fast point feature histograms (FPFH): how the normals around a keypoint, and around its neighbours, turn.
///
/// For a vertex p and each p_j with 0 < |p_j - p| <= R, s is that of the two whose normal is nearer to the line through
/// both, t the other (s = p if both are as near), and
///
///   u = n_s    v = (t - s) x u / |(t - s) x u|    w = u x v
///   theta = atan2(w . n_t, u . n_t)    alpha = v . n_t    phi = u . (t - s) / |t - s|
///   S(p) = share of these pairs in each of 11 equal bins of theta, then alpha, then phi
///   FPFH(p) = S(p) + 1/k sum R / |p_j - p| S(p_j)      over the k neighbours with a histogram
///
/// and each of the three histograms scaled to the sum 100, as in PCL. A value at the border of two bins is in that nearer to
/// the middle.
///
/// Source    [rusu2009fpfh], after later descriptions: the paper itself was not at hand. Order of the bins and scale as in
///           PCL 1.13. R is that of SHOT, so that both describe the same support.
/// Cost      O(V m) time, m vertices within R, for all V vertices within R of a keypoint; about 150 bytes for each of them.
///           Any number of threads, and any numbering of the vertices, gives the same bits.
/// Throws    InvalidInput if an option, the resolution or a keypoint is out of range, the normals are not as many as the
///           vertices, or R holds over 10000 vertices on average (and over 2e7 in all).
/// Departs   The paper weighs by 1 / distance in a space that it leaves open: here distances are in units of R, so that the
///           unit of the mesh has no effect. A pair whose line is within 1e-6 rad of u has no v, and is left out; so is a
///           pair with a normal that is zero or not finite.
///           `pcl` is the descriptor of PCL 1.13: FPFH(p) without S(p), weights 1 / |p_j - p|^2, pairs without v in the
///           middle bins, vertices at exactly R outside. What is left of PCL's differences: there pairs with a zero normal,
///           and of vertices in one place, count in middle bins too, and all arithmetic is in float.
Descriptors describe_fpfh(const Points& vertices, const Points& normals, const Indices& keypoints, double resolution,
                          const FpfhOptions& options = {}, const ParallelFor& parallel = one_by_one);

}  // namespace corral
