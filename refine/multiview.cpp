// SPDX-License-Identifier: MIT
#include "refine/multiview.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "kernel/error.h"
#include "kernel/random.h"
#include "kernel/types.h"

namespace corral {
namespace {

constexpr int kMostRounds = 50;
constexpr int kTrees = 500;
constexpr int kNobody = -1;

/// How far two motions from view a part its points, root mean square, in mesh units.
double separation(const RigidTransform& one, const RigidTransform& other, const View& view) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(one.rotation.transpose() * other.rotation));
  return std::hypot(view.radius * turn.angle(), (one * view.center - other * view.center).norm());
}

/// Sets of connected views, each with a representative.
class Parts {
 public:
  explicit Parts(std::size_t views) : leader_(views) { std::iota(leader_.begin(), leader_.end(), 0); }
  int leader(int view) const {
    while (leader_[static_cast<std::size_t>(view)] != view) view = leader_[static_cast<std::size_t>(view)];
    return view;
  }
  /// False if they are connected already. The lower representative stays.
  bool join(int a, int b) {
    a = leader(a), b = leader(b);
    leader_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<int> leader_;
};

/// Residual of one pair: radius times angle and displacement of the center, in units of the limit, times sqrt(weight).
/// Parameters: world_from_view of a and of b as quaternion and translation.
struct PairResidual {
  Eigen::Quaterniond b_from_a;
  Eigen::Vector3d translation, center;
  double radius, scale;

  template <class T>
  bool operator()(const T* qa, const T* ta, const T* qb, const T* tb, T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Quaternion<T> a(qa[0], qa[1], qa[2], qa[3]), b(qb[0], qb[1], qb[2], qb[3]);
    const Vector shift(ta[0] - tb[0], ta[1] - tb[1], ta[2] - tb[2]);
    const Eigen::Quaternion<T> aligned = b.conjugate() * a;
    const Eigen::Quaternion<T> difference = b_from_a.cast<T>().conjugate() * aligned;
    const T quaternion[4] = {difference.w(), difference.x(), difference.y(), difference.z()};
    T turn[3];
    ceres::QuaternionToAngleAxis(quaternion, turn);
    const Vector moved = aligned * center.cast<T>() + b.conjugate() * shift;
    const Eigen::Vector3d predicted = b_from_a * center + translation;
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = T(scale * radius) * turn[axis];
      residual[3 + axis] = T(scale) * (moved[axis] - T(predicted[axis]));
    }
    return true;
  }
};

class Alignment {
 public:
  Alignment(const std::vector<View>& views, const std::vector<ViewPair>& pairs, double limit, int iterations)
      : views_(views), pairs_(pairs), limit_(limit), iterations_(iterations), judged_(pairs.size()) {}

  MultiviewAlignment run() {
    count_loops();
    choose_tree();
    std::vector<bool> votes(pairs_.size(), true);  // at first the robust loss handles the wrong ones
    bool settled = false;
    for (int round = 0; round < kMostRounds && !settled; ++round) {
      solve(votes);
      const std::vector<bool> now = verdicts();
      settled = now == votes;
      votes = now;
    }
    MultiviewAlignment result;
    result.converged = settled && converged_;
    result.world_from_view = poses_;
    std::map<int, int> numbers;
    for (std::size_t view = 0; view < views_.size(); ++view)
      result.part.push_back(
          numbers.try_emplace(parts_->leader(static_cast<int>(view)), static_cast<int>(numbers.size())).first->second);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      judged_[i].verdict = !votes[i]             ? PairVerdict::Contradicts
                           : is_bridge(i, votes) ? PairVerdict::Unchecked
                                                 : PairVerdict::Agrees;
    result.pairs = judged_;
    return result;
  }

 private:
  const View& view(int index) const { return views_[static_cast<std::size_t>(index)]; }
  RigidTransform& pose(int index) { return poses_[static_cast<std::size_t>(index)]; }

  /// Triples of pairs that form a loop.
  void count_loops() {
    std::map<std::pair<int, int>, std::vector<std::size_t>> between;
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      between[{std::min(pairs_[i].a, pairs_[i].b), std::max(pairs_[i].a, pairs_[i].b)}].push_back(i);
    const auto motion = [&](std::size_t i, int from) {
      return pairs_[i].a == from ? pairs_[i].b_from_a : pairs_[i].b_from_a.inverse();
    };
    for (const auto& [ab, first] : between)
      for (auto other = between.upper_bound(ab); other != between.end() && other->first.first == ab.first; ++other) {
        const auto third = between.find({ab.second, other->first.second});
        if (third == between.end()) continue;
        for (const std::size_t i : first)
          for (const std::size_t j : third->second)
            for (const std::size_t k : other->second) {
              const int a = ab.first, b = ab.second, c = other->first.second;
              const RigidTransform around = motion(k, c) * motion(j, b) * motion(i, a);
              const bool closes = separation(around, {}, view(a)) <= std::sqrt(3.0) * limit_;
              for (const std::size_t pair : {i, j, k}) ++judged_[pair].loops, judged_[pair].closed_loops += closes;
            }
      }
  }

  /// Poses from a spanning tree of pairs: of the tree of the most trusted pairs and many random ones, which prefer pairs of
  /// closed loops, the one with which pairs of the largest total weight agree.
  void choose_tree() {
    std::vector<std::size_t> order(pairs_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> keys;
    for (std::size_t i = 0; i < pairs_.size(); ++i) keys.push_back(-judged_[i].closed_loops);
    RandomStream random(1);
    double best_weight = -1;
    std::vector<RigidTransform> best;
    for (int tree = 0; tree < kTrees; ++tree) {
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
      const double weight = plant_tree(order);
      if (weight > best_weight) best_weight = weight, best = poses_;
      for (std::size_t i = 0; i < pairs_.size(); ++i)
        keys[i] = -std::log(1 - random.uniform()) / (1 + judged_[i].closed_loops);
    }
    poses_ = best;
  }

  /// Poses from the first pairs in an order that connect all views. Returns the weight of the pairs that agree with them; the
  /// limit grows with the square root of the number of tree pairs between the two views.
  double plant_tree(const std::vector<std::size_t>& order) {
    parts_.emplace(views_.size());
    std::vector<std::vector<std::size_t>> branches(views_.size());
    for (const std::size_t i : order)
      if (parts_->join(pairs_[i].a, pairs_[i].b))
        for (const int end : {pairs_[i].a, pairs_[i].b}) branches[static_cast<std::size_t>(end)].push_back(i);
    poses_.assign(views_.size(), {});
    Indices parent(views_.size(), kNobody), depth(views_.size(), kNobody);
    for (std::size_t root = 0; root < views_.size(); ++root) {
      if (depth[root] != kNobody) continue;
      depth[root] = 0;
      Indices reached{static_cast<int>(root)};
      for (std::size_t next = 0; next < reached.size(); ++next) {
        const auto from = static_cast<std::size_t>(reached[next]);
        for (const std::size_t i : branches[from]) {
          const ViewPair& pair = pairs_[i];
          const bool is_forward = pair.a == reached[next];
          const auto to = static_cast<std::size_t>(is_forward ? pair.b : pair.a);
          if (depth[to] != kNobody) continue;
          depth[to] = depth[from] + 1;
          parent[to] = static_cast<int>(from);
          poses_[to] = poses_[from] * (is_forward ? pair.b_from_a.inverse() : pair.b_from_a);
          reached.push_back(static_cast<int>(to));
        }
      }
    }
    const auto steps_between = [&](int a, int b) {
      int steps = 0;
      for (; a != b; ++steps) {
        int& lower = depth[static_cast<std::size_t>(a)] > depth[static_cast<std::size_t>(b)] ? a : b;
        lower = parent[static_cast<std::size_t>(lower)];
      }
      return steps;
    };
    double weight = 0;
    for (const ViewPair& pair : pairs_) {
      const double error = separation(pair.b_from_a, pose(pair.b).inverse() * pose(pair.a), view(pair.a));
      if (error <= limit_ * std::sqrt(steps_between(pair.a, pair.b))) weight += pair.weight;
    }
    return weight;
  }

  /// Measures each pair against the current poses: within the limit or not.
  std::vector<bool> verdicts() {
    std::vector<bool> within;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const ViewPair& pair = pairs_[i];
      const double error = separation(pair.b_from_a, pose(pair.b).inverse() * pose(pair.a), view(pair.a));
      judged_[i].error_pr = error;
      within.push_back(error <= limit_);
    }
    return within;
  }

  void solve(const std::vector<bool>& votes) {
    std::vector<std::array<double, 4>> turns;
    for (const RigidTransform& each : poses_) {
      const Eigen::Quaterniond q(each.rotation);
      turns.push_back({q.w(), q.x(), q.y(), q.z()});
    }
    ceres::CauchyLoss loss(1);
    ceres::Problem::Options ownership;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      problem.AddParameterBlock(turns[i].data(), 4, new ceres::QuaternionManifold);
      problem.AddParameterBlock(poses_[i].translation.data(), 3);
    }
    Parts connected(views_.size());
    std::vector<std::unique_ptr<ceres::LossFunction>> weighted;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (!votes[i]) continue;
      const ViewPair& pair = pairs_[i];
      const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
      auto* residual = new PairResidual{Eigen::Quaterniond(pair.b_from_a.rotation), pair.b_from_a.translation,
                                        view(pair.a).center, view(pair.a).radius, 1 / limit_};
      weighted.push_back(std::make_unique<ceres::ScaledLoss>(&loss, pair.weight, ceres::DO_NOT_TAKE_OWNERSHIP));
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PairResidual, 6, 4, 3, 4, 3>(residual),
                               weighted.back().get(), turns[a].data(), poses_[a].translation.data(), turns[b].data(),
                               poses_[b].translation.data());
      connected.join(pair.a, pair.b);
    }
    for (std::size_t i = 0; i < views_.size(); ++i)
      if (connected.leader(static_cast<int>(i)) == static_cast<int>(i)) {
        problem.SetParameterBlockConstant(turns[i].data());
        problem.SetParameterBlockConstant(poses_[i].translation.data());
      }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.num_threads = 1;
    solver.max_num_iterations = iterations_;
    solver.function_tolerance = 1e-14;
    solver.gradient_tolerance = 1e-14;
    solver.parameter_tolerance = 1e-14;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    converged_ = summary.termination_type == ceres::CONVERGENCE;
    for (std::size_t i = 0; i < views_.size(); ++i)
      poses_[i].rotation =
          Eigen::Quaterniond(turns[i][0], turns[i][1], turns[i][2], turns[i][3]).normalized().toRotationMatrix();
  }

  /// Whether no other voting pairs connect the two views of a pair.
  bool is_bridge(std::size_t pair, const std::vector<bool>& votes) const {
    Parts others(views_.size());
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      if (i != pair && votes[i]) others.join(pairs_[i].a, pairs_[i].b);
    return others.leader(pairs_[pair].a) != others.leader(pairs_[pair].b);
  }

  const std::vector<View>& views_;
  const std::vector<ViewPair>& pairs_;
  const double limit_;
  const int iterations_;
  std::vector<PairJudgement> judged_;
  std::optional<Parts> parts_;
  std::vector<RigidTransform> poses_;
  bool converged_ = true;
};

void check(const std::vector<View>& views, const std::vector<ViewPair>& pairs, const MultiviewOptions& options) {
  require_positive("align_views", "limit_pr", options.limit_pr);
  if (options.maximum_iterations < 1)
    throw InvalidInput("align_views", "maximum_iterations", options.maximum_iterations, "at least 1");
  for (std::size_t i = 0; i < views.size(); ++i) {
    require_positive("align_views", "radius of view " + std::to_string(i), views[i].radius);
    if (!views[i].center.allFinite())
      throw InvalidInput("align_views", "center of view " + std::to_string(i), "not finite", "three finite numbers");
  }
  const int count = static_cast<int>(views.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string name = "pair " + std::to_string(i);
    for (const int end : {pairs[i].a, pairs[i].b})
      if (end < 0 || end >= count)
        throw InvalidInput("align_views", "view of " + name, std::to_string(end),
                           "one of " + std::to_string(count) + " views from 0");
    if (pairs[i].a == pairs[i].b)
      throw InvalidInput("align_views", name, "view " + std::to_string(pairs[i].a) + " with itself", "two views");
    require_positive("align_views", "weight of " + name, pairs[i].weight);
    if (!is_rotation(pairs[i].b_from_a.rotation, 1e-4) || !pairs[i].b_from_a.translation.allFinite())
      throw InvalidInput("align_views", "pose of " + name, "not rigid", "a rotation and a finite translation");
  }
}

}  // namespace

const char* to_text(PairVerdict verdict) {
  switch (verdict) {
    case PairVerdict::Agrees:
      return "agrees";
    case PairVerdict::Contradicts:
      return "contradicts";
    case PairVerdict::Unchecked:
      break;
  }
  return "unchecked";
}

View view_of(const Points& points) {
  View view;
  if (points.rows() > 0) {
    view.center = points.colwise().mean().transpose();
    view.radius = std::sqrt((points.rowwise() - view.center.transpose()).rowwise().squaredNorm().mean());
  }
  if (points.rows() == 0 || !(view.radius > 0))
    throw InvalidInput("view_of", "points", std::to_string(points.rows()) + " in one place", "two places at least");
  return view;
}

MultiviewAlignment align_views(const std::vector<View>& views, const std::vector<ViewPair>& pairs, double resolution,
                               const MultiviewOptions& options) {
  require_positive("align_views", "resolution", resolution);
  check(views, pairs, options);
  MultiviewAlignment aligned = Alignment(views, pairs, options.limit_pr * resolution, options.maximum_iterations).run();
  for (PairJudgement& pair : aligned.pairs) pair.error_pr /= resolution;
  return aligned;
}

}  // namespace corral
