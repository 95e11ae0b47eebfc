// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/view_triangulation.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/mesh/topology.h"

namespace corral {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;

constexpr const char* kWho = "triangulate_view";

/// Images are distinguished in steps of this many pr. Points on one ray, and the straight rim of a grid, would otherwise be
/// separated by the rounding of the projection.
constexpr double kStepPr = 1.0 / (1 << 20);

/// A triangle in the image that is this many steps high or less is a line made crooked by rounding to steps.
constexpr double kLineSteps = 4;

struct Camera {
  Eigen::Vector3d centre;              // the mean of the view: the image plane goes through it
  Eigen::Vector3d right, up, forward;  // right x up looks back at the sensor
  std::optional<Eigen::Vector3d> sensor;
};

Camera aim(const Points& vertices, const ViewOptions& options) {
  Camera camera;
  // Sums depend on the order of the vertices in their last bits, those of distinct_points do not.
  camera.centre = distinct_points(vertices).colwise().mean().transpose();
  if (!options.direction) camera.sensor = options.sensor;
  camera.forward = options.direction.value_or(camera.centre - options.sensor).stableNormalized();
  camera.right = camera.forward.unitOrthogonal();
  camera.up = camera.right.cross(camera.forward);
  return camera;
}

std::string to_text(const Eigen::Vector3d& point) {
  using corral::to_text;
  return to_text(point.x()) + "," + to_text(point.y()) + "," + to_text(point.z());
}

void check_in_front(const Points& vertices, const Camera& camera) {
  if (!camera.sensor) return;
  Eigen::Index behind = 0;
  for (Eigen::Index row = 0; row < vertices.rows(); ++row)
    behind += !((vertices.row(row).transpose() - *camera.sensor).dot(camera.forward) > 0);
  if (behind > 0)
    throw InvalidInput(kWho, "the sensor",
                       "at " + to_text(*camera.sensor) + " with " + std::to_string(behind) + " of " +
                           std::to_string(vertices.rows()) + " points not in front of it",
                       "the position from which all were seen (--sensor), or its viewing direction from far away "
                       "(--direction)");
}

void check(double resolution, const ViewOptions& options) {
  require_positive(kWho, "resolution", resolution);
  require_positive(kWho, "longest_edge_pr", options.longest_edge_pr);
  if (!(options.grazing_deg > 0 && options.grazing_deg <= 90))
    throw InvalidInput(kWho, "grazing_deg", options.grazing_deg, "an angle above 0 and up to 90");
  if (!options.sensor.allFinite())
    throw InvalidInput(kWho, "sensor", to_text(options.sensor), "three finite coordinates");
  if (options.direction && !(options.direction->allFinite() && options.direction->cwiseAbs().maxCoeff() > 0))
    throw InvalidInput(kWho, "direction", to_text(*options.direction), "three finite coordinates, not all zero");
}

/// Where a vertex is seen, in whole steps, and how far away.
struct Image {
  double u, v, depth;
  int vertex;
};

/// One image for each place, that of the nearest vertex; ascending, so that the result does not depend on the vertices' order.
std::vector<Image> distinct_images(const Points& vertices, const Camera& camera, double step) {
  std::vector<Image> images;
  images.reserve(static_cast<std::size_t>(vertices.rows()));
  const double distance = camera.sensor ? (camera.centre - *camera.sensor).stableNorm() : 0;
  for (int row = 0; row < static_cast<int>(vertices.rows()); ++row) {
    const Eigen::Vector3d point = vertices.row(row).transpose();
    // Across the ray through the centre, offsets from it are those from the sensor, with all their digits.
    const Eigen::Vector3d offset = point - camera.centre;
    const double depth = (point - camera.sensor.value_or(camera.centre)).dot(camera.forward);
    const double scale = camera.sensor ? distance / depth : 1;
    const double u = offset.dot(camera.right) * scale / step, v = offset.dot(camera.up) * scale / step;
    if (!std::isfinite(u) || !std::isfinite(v))
      throw InvalidInput(kWho, "the image of vertex " + std::to_string(row), "not finite",
                         "smaller finite coordinates");
    images.push_back({std::round(u), std::round(v), depth, row});
  }
  std::sort(images.begin(), images.end(), [](const Image& a, const Image& b) {
    return std::tie(a.u, a.v, a.depth, a.vertex) < std::tie(b.u, b.v, b.depth, b.vertex);
  });
  const auto same_place = [](const Image& a, const Image& b) { return a.u == b.u && a.v == b.v; };
  images.erase(std::unique(images.begin(), images.end(), same_place), images.end());
  return images;
}

using Corners = std::array<int, 3>;

bool in_line(const Kernel::Point_2& a, const Kernel::Point_2& b, const Kernel::Point_2& c) {
  const double longest =
      std::sqrt(std::max({(b - a).squared_length(), (c - b).squared_length(), (a - c).squared_length()}));
  return !(CGAL::determinant(b - a, c - a) > kLineSteps * longest);
}

std::vector<Corners> delaunay(const std::vector<Image>& images) {
  std::vector<std::pair<Kernel::Point_2, int>> places;
  places.reserve(images.size());
  for (const Image& image : images) places.emplace_back(Kernel::Point_2(image.u, image.v), image.vertex);
  const Delaunay triangulation(places.begin(), places.end());
  std::vector<Corners> found;
  for (const auto& face : triangulation.finite_face_handles()) {
    if (in_line(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point())) continue;
    Corners corners = {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    found.push_back(corners);
  }
  std::sort(found.begin(), found.end());
  return found;
}

enum class Verdict { Kept, Long, Grazing };

Verdict judge(const Points& vertices, const Corners& corners, const Camera& camera, double longest_edge,
              double least_cosine) {
  const Eigen::Vector3d a = vertices.row(corners[0]), b = vertices.row(corners[1]), c = vertices.row(corners[2]);
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  if (!(longest <= longest_edge)) return Verdict::Long;
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const Eigen::Vector3d ray = camera.sensor ? Eigen::Vector3d(*camera.sensor - (a + b + c) / 3) : -camera.forward;
  return normal.dot(ray) >= least_cosine * normal.norm() * ray.norm() ? Verdict::Kept : Verdict::Grazing;
}

}  // namespace

ViewTriangulation triangulate_view(const Points& vertices, double resolution, const ViewOptions& options) {
  check(resolution, options);
  ViewTriangulation view;
  if (vertices.rows() == 0) return view;
  const Camera camera = aim(vertices, options);
  check_in_front(vertices, camera);
  const double longest_edge = options.longest_edge_pr * resolution;
  const double least_cosine = std::cos(options.grazing_deg * (std::acos(-1.0) / 180));
  const std::vector<Image> images = distinct_images(vertices, camera, kStepPr * resolution);
  view.hidden = static_cast<int>(vertices.rows()) - static_cast<int>(images.size());
  std::vector<Corners> kept;
  for (const Corners& corners : delaunay(images)) {
    const Verdict verdict = judge(vertices, corners, camera, longest_edge, least_cosine);
    view.dropped_long += verdict == Verdict::Long;
    view.dropped_grazing += verdict == Verdict::Grazing;
    if (verdict == Verdict::Kept) kept.push_back(corners);
  }
  view.triangles.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t row = 0; row < kept.size(); ++row)
    for (int corner = 0; corner < 3; ++corner)
      view.triangles(static_cast<Eigen::Index>(row), corner) = kept[row][static_cast<std::size_t>(corner)];
  return view;
}

}  // namespace corral
