// SPDX-License-Identifier: MIT
#pragma once

// Harris 3D on meshes a second time: plain, slow and straight from the definitions, to compare with.

#include "kernel/surface/harris_mesh.h"

namespace corral::testing {

/// The response of every vertex, NaN where there is none. For meshes whose triangles are all sound.
Eigen::VectorXd reference_harris_mesh_response(const Mesh& mesh, double resolution, const HarrisMeshOptions& options);

Keypoints reference_harris_mesh(const Mesh& mesh, double resolution, const HarrisMeshOptions& options);

}  // namespace corral::testing
