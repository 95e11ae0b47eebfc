// SPDX-License-Identifier: MIT
#include "kernel/surface/normals.h"

#include <Eigen/Eigenvalues>

#include "kernel/error.h"

namespace corral {

Eigen::Vector3d plane_normal(const Points& points, const std::vector<Neighbor>& rows) {
  if (rows.size() < 3) return Eigen::Vector3d::Zero();
  const Eigen::RowVector3d origin = points.row(rows.front().index);  // near the mean: large offsets keep their digits
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const Neighbor& neighbor : rows) {
    const Eigen::RowVector3d offset = points.row(neighbor.index) - origin;
    sum += offset;
    products += offset.transpose() * offset;
  }
  const Eigen::Matrix3d covariance = products - sum.transpose() * sum / static_cast<double>(rows.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  // On one line, or in one place, every direction across has the same (no) variance.
  if (!(solver.eigenvalues()(1) > 1e-12 * solver.eigenvalues()(2))) return Eigen::Vector3d::Zero();
  return solver.eigenvectors().col(0);
}

Points estimate_normals(const Mesh& mesh, const PointIndex& index, int k) {
  if (k < 3) throw InvalidInput("estimate_normals", "k", std::to_string(k), "at least 3");
  const Points sides = area_weighted_normals(mesh);
  Points normals(mesh.vertices.rows(), 3);
  for (Eigen::Index row = 0; row < mesh.vertices.rows(); ++row) {
    const Eigen::Vector3d vertex = mesh.vertices.row(row).transpose();
    const Eigen::Vector3d normal = plane_normal(mesh.vertices, index.nearest(vertex, k));
    const Eigen::Vector3d faces = sides.row(row).transpose();
    const Eigen::Vector3d outside = faces.isZero(0) ? Eigen::Vector3d(-vertex) : faces;
    normals.row(row) = (normal.dot(outside) < 0 ? Eigen::Vector3d(-normal) : normal).transpose();
  }
  return normals;
}

}  // namespace corral
