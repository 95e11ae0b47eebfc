// SPDX-License-Identifier: MIT
// refine_benchmark [--csv] [--benchmark_...]
// CPU time of the refinement of a pose from matches of which 30 % are gross errors, one thread: ours for each loss, from
// the least-squares fit to rest, with covariance and condition, beside Eigen's umeyama and ten reweighted rounds of it.

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <memory>
#include <numeric>

#include "kernel/evaluation.h"
#include "kernel/synthetic.h"
#include "refine/refine_rigid.h"
#include "tests/benchmarks/program.h"
#include "tests/benchmarks/ratio_table.h"

namespace corral::benchmarks {
namespace {

constexpr double kScale = 5;

SyntheticProblem problem(int rows) {
  SyntheticOptions options;
  options.matches = rows;
  options.inlier_ratio = 0.7;
  return make_synthetic_problem(options);
}

/// Least squares over weighted rows, by the weighted means and one SVD.
Eigen::Matrix4d weighted_fit(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target,
                             const Eigen::RowVectorXd& weights) {
  const double sum = weights.sum();
  const Eigen::Vector3d from = source * weights.transpose() / sum, to = target * weights.transpose() / sum;
  const Eigen::Matrix3d scatter =
      ((target.colwise() - to).array().rowwise() * weights.array()).matrix() * (source.colwise() - from).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(scatter, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV()).determinant() < 0 ? -1 : 1);
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topLeftCorner<3, 3>() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  pose.topRightCorner<3, 1>() = to - pose.topLeftCorner<3, 3>() * from;
  return pose;
}

/// Eigen's umeyama, then ten rounds with Cauchy's weights.
Eigen::Matrix4d reweighted(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target) {
  Eigen::Matrix4d pose = Eigen::umeyama(source, target, false);
  for (int round = 0; round < 10; ++round) {
    const Eigen::Matrix3Xd error =
        ((pose.topLeftCorner<3, 3>() * source).colwise() + pose.topRightCorner<3, 1>().eval()) - target;
    pose = weighted_fit(source, target, (1 + error.colwise().squaredNorm().array() / (kScale * kScale)).inverse());
  }
  return pose;
}

/// The peer must do the same work: it finds the same pose, nearly (ten rounds need not be enough).
void check_peer(const SyntheticProblem& given) {
  const Eigen::Matrix4d pose =
      reweighted(given.matches.source_points.transpose(), given.matches.target_points.transpose());
  const RigidTransform found{pose.topLeftCorner<3, 3>(), pose.topRightCorner<3, 1>()};
  if (!(rotation_error_deg(found, given.truth) < 1)) throw std::runtime_error("the peer does not find the pose");
}

void add_rows(RatioTable& table, int rows) {
  const auto given = std::make_shared<SyntheticProblem>(problem(rows));
  check_peer(*given);
  const Setup peer = [given]() -> Call {
    const auto source = std::make_shared<Eigen::Matrix3Xd>(given->matches.source_points.transpose());
    const auto target = std::make_shared<Eigen::Matrix3Xd>(given->matches.target_points.transpose());
    return [source, target] { benchmark::DoNotOptimize(reweighted(*source, *target).data()); };
  };
  const auto names = choice_names(RobustLoss());
  for (std::size_t loss = 0; loss < names.size(); ++loss) {
    const Setup ours = [given, rows, loss]() -> Call {
      Indices all(static_cast<std::size_t>(rows));
      std::iota(all.begin(), all.end(), 0);
      RefineOptions options;
      options.loss = static_cast<RobustLoss>(loss);
      options.loss_scale_pr = kScale;
      return [given, all, options] { benchmark::DoNotOptimize(refine_rigid(given->matches, all, options).iterations); };
    };
    const std::string size = std::to_string(rows);
    const std::size_t row = table.add_row({{size, names[loss]}, "umeyama+10-rounds", 0, 0});
    table.add_side(size + "/" + names[loss], ours, row, Side::Ours);
    table.add_side(size + "/umeyama+10-rounds", peer, row, Side::Peer);
  }
}

int run(const Arguments& arguments) {
  RatioTable table({"rows", "loss"}, arguments.as_csv);
  for (const int rows : {100, 500, 2000, 10000}) add_rows(table, rows);
  benchmark::RunSpecifiedBenchmarks(&table);
  return 0;
}

}  // namespace
}  // namespace corral::benchmarks

int main(int argc, char** argv) {
  return corral::benchmarks::run_program("refine_benchmark", argc, argv, corral::benchmarks::run);
}
