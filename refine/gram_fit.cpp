// SPDX-License-Identifier: MIT
#include "refine/gram_fit.h"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

#include "refine/rigid_cost.h"

namespace corral {
namespace {

/// S x with S^T S = G. Parameters: a unit quaternion (w, v) and a translation.
class RootOfGram : public ceres::SizedCostFunction<13, 4, 3> {
 public:
  explicit RootOfGram(const Gram& gram) {
    const Eigen::SelfAdjointEigenSolver<Gram> eigen(gram);
    root_ = eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const double w = parameters[0][0];
    const Eigen::Vector3d v(parameters[0][1], parameters[0][2], parameters[0][3]);
    const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
    Eigen::Matrix<double, 13, 1> x;
    // R - I = 2 (w [v] + v v^T - |v|^2 I), without the cancellation of a subtraction.
    Eigen::Map<Eigen::Matrix3d>(x.data()) = 2 * (w * cross_matrix(v) + v * v.transpose() - v.squaredNorm() * unit);
    x.segment<3>(9) = Eigen::Map<const Eigen::Vector3d>(parameters[1]);
    x(12) = 1;
    Eigen::Map<Eigen::Matrix<double, 13, 1>> result(residuals);
    result = root_ * x;
    if (!jacobians) return true;
    if (jacobians[0]) {
      Eigen::Matrix<double, 9, 4> change;
      Eigen::Map<Eigen::Matrix3d>(change.col(0).data()) = 2 * cross_matrix(v);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d e = unit.col(k);
        Eigen::Map<Eigen::Matrix3d>(change.col(k + 1).data()) =
            2 * (w * cross_matrix(e) + e * v.transpose() + v * e.transpose() - 2 * v(k) * unit);
      }
      Eigen::Map<Eigen::Matrix<double, 13, 4, Eigen::RowMajor>> by_turn(jacobians[0]);
      by_turn = root_.leftCols<9>() * change;
    }
    if (jacobians[1]) {
      Eigen::Map<Eigen::Matrix<double, 13, 3, Eigen::RowMajor>> by_shift(jacobians[1]);
      by_shift = root_.middleCols<3>(9);
    }
    return true;
  }

 private:
  Gram root_;
};

}  // namespace

std::optional<GramFit> minimise(const Gram& gram) {
  if (!gram.allFinite()) return std::nullopt;
  double quaternion[4] = {1, 0, 0, 0}, shift[3] = {0, 0, 0};
  ceres::Problem problem;
  problem.AddParameterBlock(quaternion, 4, new ceres::QuaternionManifold);
  problem.AddResidualBlock(new RootOfGram(gram), nullptr, quaternion, shift);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.num_threads = 1;  // Ceres sums per thread: the result would depend on their number
  solver.function_tolerance = solver.gradient_tolerance = solver.parameter_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  const Eigen::Quaterniond turn(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
  return GramFit{{turn.normalized().toRotationMatrix(), Eigen::Map<const Eigen::Vector3d>(shift)},
                 2 * summary.initial_cost,  // Ceres minimises half the sum
                 2 * summary.final_cost};
}

}  // namespace corral
