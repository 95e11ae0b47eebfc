// SPDX-License-Identifier: MIT
// pcl_agreement MESH...
// Where our surface stages agree with PCL 1.13's, and what the differences are made of. Both get the same coordinates,
// rounded to float beforehand because PCL knows no other.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "io/mesh/mesh_file.h"
#include "kernel/surface/search/neighborhood.h"
#include "tests/benchmarks/our_stages.h"
#include "tests/peers/pcl_surface.h"

namespace corral::peers {
namespace {

constexpr double kClose = 1e-3;
/// PCL's response is 0.04f + det - 0.04f * trace^2 in float: a multiple of 3.7e-9, off by up to about this much.
constexpr double kFloatNoise = 3e-8;
constexpr double kFlat = 1e-9;  ///< our floor of the response

double percent(std::size_t part, std::size_t whole) { return whole > 0 ? 100.0 * part / whole : 100.0; }

void compare_normals(const Points& ours, const Points& theirs) {
  std::vector<double> angles;
  int only_ours = 0, only_theirs = 0;
  for (Eigen::Index row = 0; row < ours.rows(); ++row) {
    const Eigen::Vector3d a = ours.row(row), b = theirs.row(row);
    const bool have = !a.isZero(0), have_theirs = b.allFinite();
    only_ours += have && !have_theirs;
    only_theirs += have_theirs && !have;
    if (have && have_theirs) angles.push_back(std::atan2(a.cross(b).norm(), std::abs(a.dot(b))));
  }
  std::sort(angles.begin(), angles.end());
  const auto within = [&](double angle) {
    return percent(static_cast<std::size_t>(std::upper_bound(angles.begin(), angles.end(), angle) - angles.begin()),
                   angles.size());
  };
  std::printf(
      "  normals     %.3f %% within 1e-3 rad up to sign, %.3f %% within 1e-2, median %.1e; only ours %d, theirs %d\n",
      within(1e-3), within(1e-2), angles.empty() ? 0.0 : angles[angles.size() / 2], only_ours, only_theirs);
}

/// Why one side has a keypoint that the other has not.
struct Reasons {
  int flat = 0;  ///< theirs only: response below our floor
  int tie = 0;   ///< a neighbour has the same response in float, or nearly: either may win
  int other = 0;
};

/// Largest response within `radius` of a vertex other than its own.
double largest_beside(const Eigen::VectorXd& response, const PointIndex& index, const Points& vertices, int vertex,
                      double radius) {
  double largest = 0;
  for (const Neighbor& neighbor : index.within(vertices.row(vertex).transpose(), radius))
    if (neighbor.index != vertex) largest = std::max(largest, response(neighbor.index));
  return largest;
}

void compare_harris(const Mesh& mesh, const PclSurface& surface, double resolution, const Indices& theirs) {
  const double radius = 3 * resolution;
  const Indices ours = ours::harris(mesh, resolution);
  const Eigen::VectorXd response = ours::response(mesh, radius);
  const PointIndex index(mesh.vertices);
  Indices common, only_ours, only_theirs;
  std::set_intersection(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(common));
  std::set_difference(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(only_ours));
  std::set_difference(theirs.begin(), theirs.end(), ours.begin(), ours.end(), std::back_inserter(only_theirs));
  Reasons here, there;
  for (const int vertex : only_theirs) {
    const double lead = response(vertex) - largest_beside(response, index, mesh.vertices, vertex, radius);
    (response(vertex) < kFlat ? there.flat : lead >= -kFloatNoise ? there.tie : there.other)++;
  }
  for (const int vertex : only_ours) {
    const double lead = response(vertex) - largest_beside(response, index, mesh.vertices, vertex, radius);
    (lead <= kFloatNoise ? here.tie : here.other)++;
  }
  std::printf("  keypoints   ours %zu, theirs %zu, in common %zu\n", ours.size(), theirs.size(), common.size());
  std::printf("    only theirs %zu: %d flat, %d ties in float, %d other; only ours %zu: %d ties, %d other\n",
              only_theirs.size(), there.flat, there.tie, there.other, only_ours.size(), here.tie, here.other);
  const Eigen::VectorXd difference = surface.harris_response(radius).cast<double>() - response;
  std::printf("    response: largest difference %.1e, mean %.1e\n", difference.cwiseAbs().maxCoeff(),
              difference.cwiseAbs().mean());
}

void compare_iss(const Mesh& mesh, const PclSurface& surface, double resolution) {
  IssOptions options;
  options.weights = IssWeights::None;
  const Indices ours = detect_iss(mesh, resolution, options).vertices,
                theirs = surface.iss(options.salient_radius_pr * resolution, options.non_max_radius_pr * resolution);
  const Eigen::VectorXd saliency = iss_saliency(mesh, resolution, options);
  const PointIndex index(mesh.vertices);
  Indices common, apart;
  std::set_intersection(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(common));
  std::set_symmetric_difference(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(apart));
  int none = 0, tie = 0;  // of the others: no saliency for us; another vertex as salient to 1e-4
  for (const int vertex : apart) {
    const double beside =
        largest_beside(saliency, index, mesh.vertices, vertex, 1.0001 * options.non_max_radius_pr * resolution);
    none += saliency(vertex) == 0;
    tie += saliency(vertex) > 0 && std::abs(beside / saliency(vertex) - 1) < 1e-4;
  }
  std::printf(
      "  iss         ours %zu, theirs %zu, in common %zu; of the others %d without saliency here, %d ties, %d other\n",
      ours.size(), theirs.size(), common.size(), none, tie, static_cast<int>(apart.size()) - none - tie);
}

void compare_fpfh(const Mesh& mesh, const PclSurface& surface, double resolution, const Indices& keypoints,
                  const Points& normals) {
  const Descriptors ours = ours::fpfh(mesh, normals, keypoints, resolution, FpfhForm::Pcl);
  const Eigen::MatrixXf theirs = surface.fpfh(keypoints, 15 * resolution);
  std::vector<double> differences;  // the largest of each keypoint
  std::size_t next = 0;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    if (next == ours.vertices.size() || ours.vertices[next] != keypoints[i]) continue;
    const Eigen::VectorXd column = theirs.col(static_cast<Eigen::Index>(i)).cast<double>();
    differences.push_back((ours.features.col(static_cast<Eigen::Index>(next++)) - column).cwiseAbs().maxCoeff());
  }
  std::sort(differences.begin(), differences.end());
  const auto within = [&](double limit) {
    const auto end = std::upper_bound(differences.begin(), differences.end(), limit);
    return percent(static_cast<std::size_t>(end - differences.begin()), differences.size());
  };
  std::printf(
      "    fpfh        of %zu keypoints ours %zu; bins, of 100: all within 0.01 for %.2f %%, within 0.1 for %.2f %%, "
      "median %.1e, largest %.1e\n",
      keypoints.size(), ours.vertices.size(), within(0.01), within(0.1),
      differences.empty() ? 0.0 : differences[differences.size() / 2], differences.empty() ? 0.0 : differences.back());
}

bool close(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).cwiseAbs().maxCoeff() <= kClose; }

void compare_shot(const Mesh& mesh, const PclSurface& surface, double resolution, const Indices& keypoints,
                  const Points& normals) {
  const Descriptors ours = ours::shot(mesh, normals, keypoints, resolution, ShotForm::PclBug);
  const Shot theirs = surface.shot(keypoints, 15 * resolution);
  std::size_t both = 0, same_frame = 0, flipped = 0, same = 0, valid = 0, next = 0;
  double largest = 0;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    valid += theirs.valid[i];
    if (next == ours.vertices.size() || ours.vertices[next] != keypoints[i]) continue;
    const std::size_t j = next++;
    if (!theirs.valid[i]) continue;
    ++both;
    const LocalReferenceFrame& a = ours.frames[j];
    const LocalReferenceFrame& b = theirs.frames[i];
    const LocalReferenceFrame turned = (a * b.transpose()).diagonal().cwiseSign().asDiagonal() * b;
    if (!close(a, b)) {
      flipped += close(a, turned);
      continue;
    }
    ++same_frame;
    const Eigen::VectorXd x = ours.features.col(static_cast<Eigen::Index>(j)),
                          y = theirs.features.col(static_cast<Eigen::Index>(i)).cast<double>();
    same += close(x, y);
    largest = std::max(largest, (x - y).cwiseAbs().maxCoeff());
  }
  std::printf("    frames      of %zu keypoints ours %zu, theirs %zu; equal %.3f %%, an axis reversed %zu, other %zu\n",
              keypoints.size(), ours.vertices.size(), valid, percent(same_frame, both), flipped,
              both - same_frame - flipped);
  std::printf("    descriptors within 1e-3: %.2f %% of all, %.2f %% where frames are equal (largest difference %.1e)\n",
              percent(same, both), percent(same, same_frame), largest);
}

void compare(const char* path) {
  Mesh mesh = read_mesh(path);
  mesh.vertices = mesh.vertices.cast<float>().cast<double>().eval();
  PclSurface surface(mesh.vertices);
  const double ours = ours::resolution(mesh), theirs = surface.resolution();
  std::printf("%s: %d vertices\n  resolution  ours %.9g, theirs %.9g (%+.1e)\n", path,
              static_cast<int>(mesh.vertices.rows()), ours, theirs, theirs / ours - 1);
  surface.estimate_normals();
  compare_normals(ours::normals(mesh), surface.normals());
  const Indices keypoints = surface.harris(3 * ours);
  compare_harris(mesh, surface, ours, keypoints);
  compare_iss(mesh, surface, ours);
  std::printf("  with PCL's normals\n");
  const Points normals = surface.normals().array().isNaN().select(0.0, surface.normals());
  compare_shot(mesh, surface, ours, keypoints, normals);
  compare_fpfh(mesh, surface, ours, keypoints, normals);
  std::printf("  with our normals towards the origin\n");
  compare_shot(mesh, surface, ours, keypoints, estimate_normals(mesh, {20, false}));
}

}  // namespace
}  // namespace corral::peers

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: pcl_agreement MESH...\n"), 2;
  try {
    for (int i = 1; i < argc; ++i) corral::peers::compare(argv[i]);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "pcl_agreement: %s\n", error.what()), 3;
  }
}
