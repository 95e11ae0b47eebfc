// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "kernel/local_reference_frame.h"
#include "kernel/options.h"
#include "kernel/parallel.h"
#include "kernel/surface/descriptors.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/support.h"

namespace corral {

/// Length of a SHOT descriptor: 8 azimuth x 2 radial x 2 elevation volumes with 11 cosine bins each.
constexpr int kShotSize = 352;

/// How a vertex shares its vote between bins: see shot_histogram.
enum class ShotForm { Additive, Product, PclBug };
constexpr std::array<const char*, 3> choice_names(ShotForm) { return {"additive", "product", "pcl-bug"}; }

struct ShotOptions {
  double radius_pr = 15;
  int minimum_support = 10;
  ShotForm form = ShotForm::Additive;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"radius_pr", "pr", "15", "radius of the support and of the frame", above(0)}, self.radius_pr);
    visit(OptionField{"minimum_support", "", "", "vertices other than the keypoint that the support must hold",
                      at_least(0)},
          self.minimum_support);
    visit(OptionField{"form", "", "", "shares of a vote between bins: added, multiplied, or added as PCL does"},
          self.form);
  }
};

/// The repeatable frame of the surface around a point (rows x, y, z).
///
///   M = sum (R - d_i) x_i x_i^T / sum (R - d_i)  over 0 < d_i = |x_i| <= R, x_i from the point
///
/// x and z are the eigenvectors of the largest and the smallest eigenvalue, turned to the side where at least half of the
/// support lies; on an exact tie to the side of most of the five vertices around the median distance. y = z cross x.
/// Source    [tombari2010shot].
/// Returns   absent for fewer than 5 vertices, or where no finite frame exists.
/// Plain form  tests/support/reference/shot.h
std::optional<LocalReferenceFrame> shot_frame(const Support& support, double radius);

/// Where the votes of a support are counted, four copies of 32 volumes with room for 16 bins: neighbouring vertices fall into the
/// same bins, and need not wait for each other. Empty between two supports, so that it is cleared once for many of them.
struct ShotBins {
  alignas(64) double votes[4][512] = {};
};

/// The SHOT histogram of a support, unit length; absent if no vertex with a normal is in it.
///
/// For each vertex the cosine between its normal and the frame's z axis is counted in the volume that the vertex lies in.
/// Along each of the four axes (cosine, radius, elevation, azimuth) the neighbouring bin gets a share that grows with the
/// distance from the centre of the vertex's own bin, up to a half; beyond the last centre of a bounded axis the share is lost.
///   additive  the four shares are added one axis at a time, and the vertex's own bin gets the rest of each
///   product   the shares multiply, over up to 16 bins
///   pcl-bug   additive, with an error of PCL: what bin 9 of the cosine gives to bin 10 goes to bin 0 (and
///             describe_shot() leaves vertices at exactly R out of the support)
/// Order     bin = ((azimuth * 2 + shell) * 2 + above) * 11 + cosine; azimuth sectors from -180 degrees counter-clockwise,
///           shell 1 beyond R / 2, above 1 for z > 0. A sector holds its upper border. On the z axis, where there is no
///           azimuth, the vote is in sector 0: that of the other three axes, or all of it (product).
/// Source    [tombari2010shot]; additive shares, L2 norm and order as in the library that [yang2017evaluation] ran.
/// Departs   From that library: the cosine ends with its last bin (`pcl-bug` wraps), and double decides what float does there.
/// Plain form  tests/support/reference/shot.h
std::optional<Eigen::VectorXd> shot_histogram(const Support& support, const LocalReferenceFrame& frame, double radius,
                                              ShotForm form, ShotBins& bins);

/// Frames and SHOT descriptors of chosen vertices; `normals` V x 3 (zero rows are ignored). Any number of threads, and any
/// numbering of the vertices, gives the same bits.
/// Throws    InvalidInput if an option, the resolution or a keypoint is out of range, or the normals are not as many as
///           the vertices.
Descriptors describe_shot(const Points& vertices, const Points& normals, const Indices& keypoints, double resolution,
                          const ShotOptions& options = {}, const ParallelFor& parallel = one_by_one);

/// Gives the frames of SHOT to descriptors that have none: the same bits as those of describe_shot. A keypoint without a frame
/// is dropped and counted. Throws InvalidInput if an option, the resolution or a keypoint is out of range.
void add_shot_frames(const Points& vertices, double resolution, const ShotOptions& options, Descriptors& descriptors,
                     const ParallelFor& parallel = one_by_one);

}  // namespace corral
