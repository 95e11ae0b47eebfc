// SPDX-License-Identifier: MIT
#include "refine/refine_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/error.h"
#include "refine/gram_fit.h"

namespace corral {
namespace {

constexpr int kFewestPairs = 6;  // as many as a pose has parts
constexpr int kMostInVain = 3;   // rounds of a level without a new lowest cost: pairs that change to and fro
constexpr int kBlock = 128;      // pairs whose columns are multiplied together

/// The columns whose products make up the sums: of a plane pair the 13 of its residual, of a point pair those that its three
/// residuals share. m is the moved point, d = m - q, all in pr about a centre.
struct PlaneColumns {
  static constexpr int kWidth = 13;
  template <class Row>
  static void set(Row row, const Eigen::Vector3d& m, const Eigen::Vector3d& d, const Eigen::Vector3d& n) {
    for (int axis = 0; axis < 3; ++axis) row.template segment<3>(3 * axis) = m(axis) * n.transpose();
    row.template segment<3>(9) = n.transpose();
    row(12) = n.dot(d);
  }
  static Gram gram(const Eigen::Matrix<double, kWidth, kWidth>& sums) { return sums; }
};

struct PointColumns {
  static constexpr int kWidth = 7;
  template <class Row>
  static void set(Row row, const Eigen::Vector3d& m, const Eigen::Vector3d& d, const Eigen::Vector3d&) {
    row.template head<3>() = m.transpose();
    row(3) = 1;
    row.template tail<3>() = d.transpose();
  }
  static Gram gram(const Eigen::Matrix<double, kWidth, kWidth>& sums) {
    Gram gram = Gram::Zero();  // r_axis = sum_j (R - I)(axis, j) m_j + t_axis + d_axis
    for (int axis = 0; axis < 3; ++axis) {
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) gram(3 * j + axis, 3 * k + axis) = sums(j, k);
        gram(3 * j + axis, 12) = gram(12, 3 * j + axis) = sums(j, 4 + axis);
      }
      gram(12, 12) += sums(4 + axis, 4 + axis);
    }
    return gram;
  }
};

/// The pairs of one pose and what the rest needs of them.
struct Pairing {
  Eigen::Index points = 0, pairs = 0;
  Gram gram = Gram::Zero();

  double overlap() const { return points > 0 ? static_cast<double>(pairs) / static_cast<double>(points) : 0; }
  double squares() const { return gram(12, 12); }  // pr^2
  double rms_pr() const { return pairs > 0 ? std::sqrt(squares() / static_cast<double>(pairs)) : 0; }
  double cost(double limit_pr) const {
    return (squares() + static_cast<double>(points - pairs) * limit_pr * limit_pr) / static_cast<double>(points);
  }
};

class SurfaceRefiner {
 public:
  SurfaceRefiner(const SurfacePair& surfaces, const SurfaceOptions& options)
      : surfaces_(surfaces), options_(options), unit_(surfaces.resolution) {}

  RefinedSurface run(const RigidTransform& start) {
    pose_ = start;
    const double last_limit_pr = options_.levels.back().limit_pr;
    const Pairing before = pair_all(last_limit_pr);
    result_.before = {before.overlap(), before.rms_pr()};
    for (const SurfaceLevel& level : options_.levels) {
      if (refine(level)) continue;
      finish(last_limit_pr);
      return result_;
    }
    result_.status = SurfaceStatus::Refined;
    const Pairing after = finish(last_limit_pr);
    if (!is_enough(after))
      result_.status = SurfaceStatus::TooLittleOverlap;
    else if (!(result_.condition <= options_.largest_condition))
      result_.status = SurfaceStatus::DegenerateGeometry;
    else
      result_.target_from_source = pose_;
    return result_;
  }

 private:
  bool is_enough(const Pairing& pairing) const {
    return pairing.pairs >= kFewestPairs && pairing.overlap() >= options_.least_overlap;
  }

  /// Every so manieth source point.
  void take(int step) {
    const Eigen::Index count = (surfaces_.source.rows() + step - 1) / step;
    taken_ = surfaces_.source(Eigen::seqN(0, count, step), Eigen::all);
    if (count == 0) return;
    const Eigen::RowVector3d mean = taken_.colwise().mean();
    size_pr_ = std::sqrt((taken_.rowwise() - mean).rowwise().squaredNorm().mean()) / unit_;
  }

  Pairing pair(double limit_pr) {
    return options_.residual == SurfaceResidual::PointToPlane ? pair_by<PlaneColumns>(limit_pr)
                                                              : pair_by<PointColumns>(limit_pr);
  }

  template <class Columns>
  Pairing pair_by(double limit_pr) {
    constexpr int kWidth = Columns::kWidth;
    moved_ = pose_.apply(taken_);
    const Indices& nearest = surfaces_.nearest(moved_, limit_pr * unit_);
    centre_ = moved_.rows() > 0 ? Eigen::Vector3d(moved_.colwise().mean().transpose()) : Eigen::Vector3d::Zero();
    Eigen::Matrix<double, kWidth, kWidth> sums = Eigen::Matrix<double, kWidth, kWidth>::Zero();
    Eigen::Matrix<double, kBlock, kWidth, Eigen::RowMajor> block;
    int filled = 0;
    const auto add_block = [&] {
      sums.noalias() += block.topRows(filled).transpose() * block.topRows(filled);
      filled = 0;
    };
    partners_.clear();
    Pairing pairing;
    pairing.points = moved_.rows();
    for (Eigen::Index i = 0; i < moved_.rows(); ++i) {
      const int row = nearest[static_cast<std::size_t>(i)];
      if (row < 0) continue;
      const Eigen::Vector3d n = surfaces_.target_normals.row(row).transpose();
      if (!(n.squaredNorm() > 0)) continue;
      const Eigen::Vector3d m = moved_.row(i).transpose();
      Columns::set(block.row(filled++), (m - centre_) / unit_, (m - surfaces_.target.row(row).transpose()) / unit_, n);
      ++pairing.pairs;
      partners_.push_back(row);
      if (filled == kBlock) add_block();
    }
    add_block();
    pairing.gram = Columns::gram(sums);
    return pairing;
  }

  Pairing pair_all(double limit_pr) {
    take(1);
    return pair(limit_pr);
  }

  /// The last word on a pose: overlap, residual and condition over all points.
  Pairing finish(double limit_pr) {
    const Pairing after = pair_all(limit_pr);
    result_.after = {after.overlap(), after.rms_pr()};
    result_.condition = condition();
    return after;
  }

  /// Of the point-to-plane equations of the last pairs, taken at their target points.
  double condition() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto count = static_cast<Eigen::Index>(partners_.size());
    if (count < kFewestPairs) return kInfinity;
    Points arms(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) arms.row(i) = surfaces_.target.row(partners_[static_cast<std::size_t>(i)]);
    arms.rowwise() -= arms.colwise().mean().eval();
    const double size = std::sqrt(arms.rowwise().squaredNorm().mean());
    if (!(size > 0)) return kInfinity;
    Eigen::Matrix<double, 6, 6> equations = Eigen::Matrix<double, 6, 6>::Zero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector3d n = surfaces_.target_normals.row(partners_[static_cast<std::size_t>(i)]).transpose();
      const Eigen::Vector3d arm = arms.row(i).transpose() / size;
      Eigen::Matrix<double, 6, 1> a;
      a << arm.cross(n), n;
      equations.noalias() += a * a.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(equations, Eigen::EigenvaluesOnly);
    const double least = eigen.eigenvalues()(0), most = eigen.eigenvalues()(5);
    return least > 0 ? most / least : kInfinity;
  }

  /// False, with the reason in the status, if there is nothing to go on with.
  bool refine(const SurfaceLevel& level) {
    take(level.step);
    result_.levels.emplace_back();
    double lowest = std::numeric_limits<double>::infinity();
    int in_vain = 0;
    for (int round = 0; round < level.most_rounds; ++round) {
      const Pairing pairing = pair(level.limit_pr);
      if (!is_enough(pairing)) {
        result_.status = SurfaceStatus::TooLittleOverlap;
        return false;
      }
      const double cost = pairing.cost(level.limit_pr);
      in_vain = cost < lowest ? 0 : in_vain + 1;
      lowest = std::min(lowest, cost);
      if (in_vain == kMostInVain) break;
      const auto fit = minimise(pairing.gram);
      if (!fit) {
        result_.status = SurfaceStatus::Diverged;
        return false;
      }
      result_.levels.back().push_back({pairing.overlap(), cost, fit->squares_before, fit->squares_after});
      pose_ = about_centre(fit->motion) * pose_;
      // No point turns farther than its distance from the centre times the norm of R - I.
      const double turn = (fit->motion.rotation - Eigen::Matrix3d::Identity()).norm();
      if (turn * size_pr_ + fit->motion.translation.norm() < options_.rest_pr) break;
    }
    return true;
  }

  /// A step in pr about the centre, as a motion in mesh units.
  RigidTransform about_centre(const RigidTransform& step) const {
    return {step.rotation, centre_ + unit_ * step.translation - step.rotation * centre_};
  }

  const SurfacePair& surfaces_;
  const SurfaceOptions& options_;
  double unit_;  // mesh units per pr
  RigidTransform pose_;
  Points taken_, moved_;
  double size_pr_ = 0;                                // root mean square distance of the taken points from their mean
  Indices partners_;                                  // target points of the last pairs
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  // of the moved points, mesh units
  RefinedSurface result_;
};

void check(const SurfacePair& surfaces, const RigidTransform& start, const SurfaceOptions& options) {
  const std::string who = "refine_surface";
  require_positive(who, "resolution", surfaces.resolution);
  if (surfaces.target.rows() != surfaces.target_normals.rows())
    throw InvalidInput(who, "target_normals", static_cast<double>(surfaces.target_normals.rows()),
                       "one row per target point");
  if (!start.rotation.allFinite() || !start.translation.allFinite())
    throw InvalidInput(who, "start", "a value that is not finite", "a finite motion");
  if (options.levels.empty()) throw InvalidInput(who, "levels", "none", "at least one");
  for (const SurfaceLevel& level : options.levels) {
    require_positive(who, "limit_pr", level.limit_pr);
    if (level.step < 1) throw InvalidInput(who, "step", level.step, "at least 1");
    if (level.most_rounds < 1) throw InvalidInput(who, "most_rounds", level.most_rounds, "at least 1");
  }
  if (!(options.rest_pr >= 0)) throw InvalidInput(who, "rest_pr", options.rest_pr, "at least 0");
  if (!(options.least_overlap >= 0 && options.least_overlap <= 1))
    throw InvalidInput(who, "least_overlap", options.least_overlap, "0 to 1");
  require_positive(who, "largest_condition", options.largest_condition);
}

}  // namespace

const char* to_text(SurfaceStatus status) {
  switch (status) {
    case SurfaceStatus::Refined:
      return "refined";
    case SurfaceStatus::TooLittleOverlap:
      return "too little overlap";
    case SurfaceStatus::DegenerateGeometry:
      return "degenerate geometry";
    case SurfaceStatus::Diverged:
      break;
  }
  return "diverged";
}

RefinedSurface refine_surface(const SurfacePair& surfaces, const RigidTransform& start, const SurfaceOptions& options) {
  check(surfaces, start, options);
  return SurfaceRefiner(surfaces, options).run(start);
}

}  // namespace corral
