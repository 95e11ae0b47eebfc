// SPDX-License-Identifier: MIT
#include "kernel/surface/scan/range_scan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "kernel/bounding_box.h"
#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/surface/scan/view_triangulation.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

constexpr const char* kWho = "scan_range";
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostRays = 1 << 26;
constexpr double kRadians = 0.017453292519943295;

/// The cells of the image that a surface may be seen in, ends included.
struct Window {
  double top = kInfinity, bottom = -kInfinity, left = kInfinity, right = -kInfinity;

  void add(double row, double column) {
    top = std::min(top, row), bottom = std::max(bottom, row);
    left = std::min(left, column), right = std::max(right, column);
  }
  void add(const Window& other) { add(other.top, other.left), add(other.bottom, other.right); }
  bool holds(double row, double column) const {
    return row >= top && row <= bottom && column >= left && column <= right;
  }
  double cells() const { return (bottom - top + 1) * (right - left + 1); }
};

/// A surface in the frame of the sensor.
struct Seen {
  const SurfaceTree* surface;
  RigidTransform mesh_from_sensor;
  Window window;
};

Seen see(const PosedSurface& posed, const RigidTransform& sensor_from_world, double step) {
  const RigidTransform sensor_from_mesh = sensor_from_world * posed.world_from_mesh;
  Seen seen{posed.surface, sensor_from_mesh.inverse(), {}};
  const Points vertices = sensor_from_mesh.apply(posed.surface->mesh().vertices);
  for (Eigen::Index row = 0; row < vertices.rows(); ++row) {
    const double depth = -vertices(row, 2);
    if (!(depth > 0))
      throw InvalidInput(kWho, "the sensor", "with vertex " + std::to_string(row) + " of a surface not in front of it",
                         "a position further away");
    const double up = vertices(row, 1) / depth / step, right = vertices(row, 0) / depth / step;
    seen.window.add(std::floor(-up), std::floor(right));
    seen.window.add(std::ceil(-up), std::ceil(right));
  }
  return seen;
}

struct Hit {
  int surface, triangle, column;
  Eigen::Vector3d ray;
  double distance, area;
};

class Scanner {
 public:
  Scanner(const PosedSurfaces& scene, const RangeSensor& sensor, const RangeScanOptions& options)
      : options_(options),
        step_(options.spacing / (sensor.target - sensor.position).norm()),
        least_cosine_(std::cos(options.grazing_deg * kRadians)) {
    const RigidTransform sensor_from_world = sensor.sensor_from_world();
    for (const PosedSurface& posed : scene) {
      seen_.push_back(see(posed, sensor_from_world, step_));
      window_.add(seen_.back().window);
    }
    if (!(window_.cells() <= kMostRays))
      throw InvalidInput(kWho, "spacing", options.spacing,
                         "a length that makes at most 2^26 rays (this one makes " +
                             std::to_string(static_cast<long long>(std::min(window_.cells(), 1e18))) + ")");
  }

  int rows() const { return static_cast<int>(window_.bottom - window_.top) + 1; }
  int image_row(int row) const { return row + static_cast<int>(window_.top); }

  /// The returns of a row of the image; distances with noise, areas without.
  std::vector<Hit> scan_row(int row) const {
    RandomStream random(derive_seed(options_.seed, "row " + std::to_string(image_row(row))));
    std::vector<Hit> hits;
    for (double column = window_.left; column <= window_.right; ++column) {
      std::optional<Hit> hit = cast(window_.top + row, column);
      if (!hit) continue;
      if (options_.noise > 0) hit->distance += options_.noise * random.normal();
      hits.push_back(*hit);
    }
    return hits;
  }

 private:
  std::optional<Hit> cast(double row, double column) const {
    const Eigen::Vector3d through(column * step_, -row * step_, -1);
    const double length = through.norm();
    const Eigen::Vector3d ray = through / length;
    std::optional<RayHit> nearest;
    int surface = -1;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (!seen_[i].window.holds(row, column)) continue;
      const RigidTransform& to_mesh = seen_[i].mesh_from_sensor;
      const auto hit = seen_[i].surface->first_hit(to_mesh.translation, to_mesh.rotation * ray);
      if (hit && (!nearest || hit->distance < nearest->distance)) nearest = hit, surface = static_cast<int>(i);
    }
    if (!nearest || !(nearest->cosine >= least_cosine_)) return std::nullopt;
    const double across = nearest->distance * step_ / length;
    return Hit{surface, nearest->triangle, static_cast<int>(column),
               ray,     nearest->distance, across * across / (length * nearest->cosine)};
  }

  const RangeScanOptions& options_;
  double step_, least_cosine_;
  std::vector<Seen> seen_;
  Window window_;
};

void check(const PosedSurfaces& scene, const RangeScanOptions& options) {
  if (scene.empty()) throw InvalidInput(kWho, "surfaces", "none", "at least one");
  require_positive(kWho, "spacing", options.spacing);
  if (!(options.noise >= 0) || !std::isfinite(options.noise))
    throw InvalidInput(kWho, "noise", options.noise, "a finite length of at least 0");
  if (!(options.grazing_deg > 0 && options.grazing_deg <= 90))
    throw InvalidInput(kWho, "grazing_deg", options.grazing_deg, "an angle above 0 and up to 90");
}

}  // namespace

RigidTransform RangeSensor::sensor_from_world() const {
  const Eigen::Vector3d back = position - target;
  if (!back.allFinite() || !up.allFinite() || !(back.norm() > 0))
    throw InvalidInput("RangeSensor", "position", "at its target or not finite", "a finite position away from it");
  Eigen::Matrix3d rotation;
  const Eigen::Vector3d z = back.normalized(), across = up.cross(z);
  const Eigen::Vector3d x = across.norm() > 1e-9 * up.norm() ? across.normalized() : z.unitOrthogonal();
  rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  return {rotation, -(rotation * position)};
}

RangeSensor ring_sensor(const Mesh& mesh, int i, int n, double distance) {
  if (!(i >= 0 && i < n))
    throw InvalidInput("ring_sensor", "view", static_cast<double>(i),
                       "a number of a view, 0 .. " + std::to_string(n - 1));
  const double turn = 360 * kRadians * i / n, tilt = 25 * kRadians * std::sin(2 * turn);
  const Eigen::Vector3d away(std::cos(tilt) * std::sin(turn), std::sin(tilt), std::cos(tilt) * std::cos(turn));
  const BoundingBox box = bounding_box(mesh.vertices);
  RangeSensor sensor;
  sensor.target = box.middle().transpose();
  sensor.position = sensor.target + distance * box.diagonal() * away;
  sensor.up = Eigen::AngleAxisd(137.5 * kRadians * i, away) * Eigen::Vector3d::UnitY();
  return sensor;
}

RangeScan scan_range(const PosedSurfaces& scene, const RangeSensor& sensor, const RangeScanOptions& options,
                     const ParallelFor& parallel) {
  check(scene, options);
  RangeScan scan;
  scan.sensor_from_world = sensor.sensor_from_world();
  scan.patch_areas.assign(scene.size(), 0.0);
  const Scanner scanner(scene, sensor, options);
  std::vector<std::vector<Hit>> rows(static_cast<std::size_t>(scanner.rows()));
  parallel(scanner.rows(), [&](int row) { rows[static_cast<std::size_t>(row)] = scanner.scan_row(row); });
  const auto add = [](std::size_t sum, const std::vector<Hit>& hits) { return sum + hits.size(); };
  scan.points.resize(static_cast<Eigen::Index>(std::accumulate(rows.begin(), rows.end(), std::size_t{0}, add)), 3);
  Eigen::Index point = 0;
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (const Hit& hit : rows[row]) {
      scan.points.row(point++) = hit.distance * hit.ray.transpose();
      scan.surfaces.push_back(hit.surface);
      scan.triangles.push_back(hit.triangle);
      scan.image_rows.push_back(scanner.image_row(static_cast<int>(row)));
      scan.image_columns.push_back(hit.column);
      scan.patch_areas[static_cast<std::size_t>(hit.surface)] += hit.area;
    }
  return scan;
}

Mesh triangulated(const RangeScan& scan) {
  return {scan.points, triangulate_view(scan.points, point_resolution(scan.points)).triangles};
}

}  // namespace corral
