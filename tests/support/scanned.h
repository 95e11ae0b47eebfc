// SPDX-License-Identifier: MIT
#pragma once

// Surfaces before a sensor, for tests.

#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/scan/range_scan.h"
#include "tests/support/meshes.h"

namespace corral::testing {

inline RangeSensor looking_at(const Eigen::Vector3d& target, const Eigen::Vector3d& from) {
  RangeSensor sensor;
  sensor.position = from;
  sensor.target = target;
  return sensor;
}

inline RangeScanOptions with_spacing(double spacing) {
  RangeScanOptions options;
  options.spacing = spacing;
  return options;
}

inline RigidTransform shift(double x, double y, double z) { return {Eigen::Matrix3d::Identity(), {x, y, z}}; }

}  // namespace corral::testing
