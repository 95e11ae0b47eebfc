// SPDX-License-Identifier: MIT
#include "refine/rigid_descent.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace corral {
namespace {

/// Relative change of the cost that ends a descent, and that ends a round on the way to the last scale.
constexpr double kRest = 1e-14, kRound = 1e-4;

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// All pairs as seven residuals f of a pose (quaternion; shift in extents) with |f|^2 = E, J^T f its gradient and J^T J its
/// normal matrix N = L L^T: J = L^T and f = (L^-1 gradient, the rest). The rest exists since rho(s) >= s rho'(s), concave
/// as rho is. Ceres then evaluates the true robust cost in one pass over the pairs; it asks for a pose that it accepts twice
/// in a row, of which the second time is answered from memory.
class RigidCostFunction final : public ceres::SizedCostFunction<7, 4, 3> {
 public:
  RigidCostFunction(const MatchedPoints& pairs, const ScaledLoss& loss, double extent)
      : pairs_(pairs), loss_(loss), extent_(extent) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Quaterniond rotation(parameters[0]);
    const RigidTransform pose{rotation.toRotationMatrix(), extent_ * Eigen::Map<const Eigen::Vector3d>(parameters[1])};
    const RigidCost& at = cost_at(pose);
    Eigen::Matrix<double, 6, 1> unit = Eigen::Matrix<double, 6, 1>::Ones();
    unit.tail<3>().setConstant(extent_);
    const Eigen::LLT<Matrix6> factor(unit.asDiagonal() * at.normal * unit.asDiagonal());
    if (factor.info() != Eigen::Success) return false;  // the pairs with remaining weight determine no pose
    if (!std::isfinite(at.cost) || !factor.matrixLLT().allFinite()) return false;

    Eigen::Map<Eigen::Matrix<double, 7, 1>> f(residuals);
    f.head<6>() = factor.matrixL().solve(unit.cwiseProduct(at.gradient));
    f(6) = std::sqrt(std::max(0.0, at.cost - f.head<6>().squaredNorm()));
    if (!jacobians) return true;
    const Matrix6 jacobian = factor.matrixU();
    if (jacobians[0])
      Eigen::Map<Eigen::Matrix<double, 7, 4, Eigen::RowMajor>>(jacobians[0])
          << jacobian.leftCols<3>() * turn_by_quaternion(rotation),
          Eigen::RowVector4d::Zero();
    if (jacobians[1])
      Eigen::Map<Eigen::Matrix<double, 7, 3, Eigen::RowMajor>>(jacobians[1]) << jacobian.rightCols<3>(),
          Eigen::RowVector3d::Zero();
    return true;
  }

 private:
  const RigidCost& cost_at(const RigidTransform& pose) const {
    if (!latest_ || latest_->rotation != pose.rotation || latest_->translation != pose.translation) {
      latest_cost_ = rigid_cost(pairs_, pose, loss_);
      latest_ = pose;
    }
    return latest_cost_;
  }

  const MatchedPoints& pairs_;
  const ScaledLoss loss_;
  const double extent_;
  mutable std::optional<RigidTransform> latest_;
  mutable RigidCost latest_cost_;
};

ceres::Solver::Options solver_options(double tolerance, int iterations) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.num_threads = 1;  // Ceres sums per thread: the result would depend on their number
  solver.max_num_iterations = iterations;
  solver.function_tolerance = tolerance;
  solver.gradient_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-14;
  solver.logging_type = ceres::SILENT;
  return solver;
}

RigidDescent descend(const MatchedPoints& pairs, const RigidTransform& start, const ScaledLoss& loss,
                     const ceres::Solver::Options& solver) {
  RigidDescent found{start, rigid_cost(pairs, start, loss).cost, false, false, 0};
  const double extent = pairs.source.norm() / std::sqrt(static_cast<double>(pairs.source.rows()));
  Eigen::Quaterniond rotation(start.rotation);
  Eigen::Vector3d shift = start.translation / extent;
  const std::array<double*, 2> parameters{rotation.coeffs().data(), shift.data()};
  RigidCostFunction function(pairs, loss, extent);
  std::array<double, 7> residuals;
  if (!function.Evaluate(parameters.data(), residuals.data(), nullptr)) return found;  // Ceres would print an error

  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddParameterBlock(parameters[0], 4, new ceres::EigenQuaternionManifold);
  problem.AddResidualBlock(&function, nullptr, parameters[0], parameters[1]);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  found.is_usable = summary.IsSolutionUsable();
  found.converged = summary.termination_type == ceres::CONVERGENCE;
  found.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  const RigidTransform pose{rotation.normalized().toRotationMatrix(), extent * shift};
  const double cost = rigid_cost(pairs, pose, loss).cost;
  if (found.is_usable && cost < found.cost) found.pose = pose, found.cost = cost;  // else they differ by rounding
  return found;
}

double largest_residual(const MatchedPoints& pairs, const RigidTransform& pose) {
  return std::sqrt((pose.apply(pairs.source) - pairs.target).rowwise().squaredNorm().maxCoeff());
}

}  // namespace

RigidDescent descend_rigid_cost(const MatchedPoints& pairs, const RigidTransform& start, const ScaledLoss& loss,
                                int maximum_iterations) {
  RigidDescent direct = descend(pairs, start, loss, solver_options(kRest, maximum_iterations));
  double scale = largest_residual(pairs, start) / graduation_reach(loss.loss);
  if (!(scale > loss.scale)) return direct;

  int iterations = direct.iterations;
  RigidTransform pose = start;
  for (; scale > loss.scale; scale /= 2) {
    const RigidDescent round =
        descend(pairs, pose, {loss.loss, scale}, solver_options(kRound, maximum_iterations - iterations));
    iterations += round.iterations;
    pose = round.pose;
  }
  RigidDescent graduated = descend(pairs, pose, loss, solver_options(kRest, maximum_iterations - iterations));
  iterations += graduated.iterations;
  const bool is_better = graduated.is_usable && !(direct.is_usable && direct.cost <= graduated.cost);
  RigidDescent best = is_better ? graduated : direct;
  best.iterations = iterations;
  return best;
}

}  // namespace corral
