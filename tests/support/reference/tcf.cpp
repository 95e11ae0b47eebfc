// SPDX-License-Identifier: MIT
#include "tests/support/reference/tcf.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/random.h"
#include "kernel/rigid_transform.h"

namespace corral::reference {
namespace {

class Tcf {
 public:
  Tcf(const CorrespondenceSet& matches, const TcfOptions& options)
      : m_(matches),
        o_(options),
        n_(matches.size()),
        t_(options.length_pr * matches.resolution),
        random_(options.seed) {
    f_.resize(n_, n_);
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j) f_(i, j) = std::abs((p(i) - p(j)).norm() - (q(i) - q(j)).norm()) < 2 * t_;
  }

  Indices run() {
    const Indices one = stage_one();
    if (one.size() < 3) return {};
    const Indices two = stage_two(one);
    if (two.size() < 3) return {};
    const auto pose = stage_three(two);
    if (!pose) return {};
    Indices rows;
    for (int i = 0; i < n_; ++i)
      if (residual(*pose, i) < o_.tolerance_pr * m_.resolution) rows.push_back(i);
    return rows.size() < 3 ? Indices{} : rows;
  }

 private:
  Eigen::Vector3d p(int i) const { return m_.source_points.row(i); }
  Eigen::Vector3d q(int i) const { return m_.target_points.row(i); }
  double residual(const RigidTransform& pose, int i) const { return (pose * p(i) - q(i)).norm(); }
  int draw(std::size_t count) { return static_cast<int>(random_.below(count)); }

  long sum_of(const Indices& rows) const { return f_(rows, rows).sum(); }
  static int size_of(long sum) { return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(sum)))); }
  int trials_of(double share, int power, int trials) const {
    const double needed = std::log(0.01) / std::log1p(-std::pow(share, power));
    return std::min(trials, needed < o_.max_trials ? static_cast<int>(std::ceil(needed)) : o_.max_trials);
  }

  Indices stage_one() {
    Indices best;
    int best_size = 0, trials = o_.max_trials;
    long best_sum = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const int r = draw(static_cast<std::size_t>(n_));
      Indices rows;
      for (int i = 0; i < n_; ++i)
        if (f_(r, i)) rows.push_back(i);
      for (int round = 0; round < 50; ++round) {
        const auto keep = static_cast<std::size_t>(size_of(sum_of(rows)));
        if (rows.size() - keep < 5) break;
        std::vector<std::pair<int, int>> order;  // larger sums first, then the lower row
        for (const int i : rows) order.emplace_back(-f_(i, rows).sum(), i);
        std::sort(order.begin(), order.end());
        rows.clear();
        for (std::size_t k = 0; k < keep; ++k) rows.push_back(order[k].second);
        std::sort(rows.begin(), rows.end());
      }
      const long sum = sum_of(rows);
      const int size = size_of(sum);
      if (size < best_size || (size == best_size && sum <= best_sum)) continue;
      best = rows, best_size = size, best_sum = sum;
      trials = trials_of(1.0 * size / n_, 1, trials);
    }
    return best;
  }

  double angle_at(int k, int a, int b, bool in_source) const {
    const Eigen::Vector3d x = in_source ? p(a) - p(k) : q(a) - q(k), y = in_source ? p(b) - p(k) : q(b) - q(k);
    return std::atan2(x.cross(y).norm(), x.dot(y));
  }
  double slack(int k, int other) const {
    const double length = (p(k) - p(other)).norm();
    return std::asin(length > 0 ? std::min(0.9999, 2 * t_ / length) : 0.9999);
  }

  Indices stage_two(const Indices& rows) {
    Indices best;
    int best_size = 0, trials = o_.max_trials;
    long best_sum = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const int a = rows[static_cast<std::size_t>(draw(rows.size()))],
                b = rows[static_cast<std::size_t>(draw(rows.size()))];
      if (a == b || !f_(a, b)) continue;
      Indices common;
      for (const int k : rows) {
        const bool is_end = k == a || k == b;
        if (is_end || (f_(a, k) && f_(b, k) &&
                       std::abs(angle_at(k, a, b, true) - angle_at(k, a, b, false)) < slack(k, a) + slack(k, b)))
          common.push_back(k);
      }
      const long sum = sum_of(common);
      const int size = size_of(sum);
      if (size < best_size || (size == best_size && sum <= best_sum)) continue;
      best = common, best_size = size, best_sum = sum;
      trials = trials_of(1.0 * size / static_cast<double>(rows.size()), 2, trials);
    }
    return best;
  }

  bool is_flat(const Indices& t) const {
    const double limit = 1e-3 * m_.resolution * m_.resolution;
    return !((p(t[1]) - p(t[0])).cross(p(t[2]) - p(t[0])).norm() / 2 > limit) ||
           !((q(t[1]) - q(t[0])).cross(q(t[2]) - q(t[0])).norm() / 2 > limit);
  }

  /// Weighted Kabsch on the rows, absent where they lie on a line.
  std::optional<RigidTransform> fit(const Indices& rows, const std::vector<double>& w) const {
    double total = 0;
    Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
    for (std::size_t k = 0; k < rows.size(); ++k) total += w[k], a += w[k] * p(rows[k]), b += w[k] * q(rows[k]);
    a /= total, b /= total;
    Eigen::MatrixXd x(rows.size(), 3), y(rows.size(), 3);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      x.row(static_cast<int>(k)) = std::sqrt(w[k]) * (p(rows[k]) - a).transpose();
      y.row(static_cast<int>(k)) = std::sqrt(w[k]) * (q(rows[k]) - b).transpose();
    }
    const double limit = 1e-3 * m_.resolution * std::sqrt(total);
    if (rows.size() < 3) return std::nullopt;
    for (const Eigen::MatrixXd& side : {x, y})
      if (!(Eigen::JacobiSVD<Eigen::MatrixXd>(side).singularValues()(1) > limit)) return std::nullopt;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(x.transpose() * y, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
    RigidTransform pose;
    pose.rotation = svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
    pose.translation = b - pose.rotation * a;
    return pose;
  }

  std::optional<RigidTransform> stage_three(const Indices& rows) {
    std::optional<RigidTransform> best;
    std::size_t best_count = 0;
    double best_mae = 0;
    const auto agreeing_with = [&](const RigidTransform& pose) {
      Indices agreeing;  // places in `rows`
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (residual(pose, rows[k]) < t_) agreeing.push_back(static_cast<int>(k));
      return agreeing;
    };
    const auto is_new_best = [&](const RigidTransform& pose) {
      const Indices agreeing = agreeing_with(pose);
      double mae = 0;
      for (const int k : agreeing) mae += 1 - residual(pose, rows[static_cast<std::size_t>(k)]) / t_;
      if (best && (agreeing.size() < best_count || (agreeing.size() == best_count && mae <= best_mae))) return false;
      best = pose, best_count = agreeing.size(), best_mae = mae;
      return true;
    };
    int trials = o_.max_trials;
    for (int trial = 0; trial < trials; ++trial) {
      Indices t;
      for (int corner = 0; corner < 3; ++corner) t.push_back(rows[static_cast<std::size_t>(draw(rows.size()))]);
      if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2] || is_flat(t)) continue;
      const auto pose = fit_rigid_transform(m_, t);
      if (!pose || !is_new_best(*pose)) continue;
      trials = trials_of(1.0 * static_cast<double>(best_count) / static_cast<double>(rows.size()), 3, trials);
      Indices places = agreeing_with(*pose);
      if (trial < 50 || places.size() < 3) continue;
      for (int again = 0; again < 50; ++again) {
        Indices some;
        for (std::size_t k = 0; k < std::min<std::size_t>(21, places.size()); ++k) {
          std::swap(places[k], places[k + static_cast<std::size_t>(draw(places.size() - k))]);
          some.push_back(rows[static_cast<std::size_t>(places[k])]);
        }
        const auto local = fit(some, std::vector<double>(some.size(), 1));
        if (local && is_new_best(*local))
          trials = trials_of(1.0 * static_cast<double>(best_count) / static_cast<double>(rows.size()), 3, trials);
      }
    }
    if (!best) return std::nullopt;
    Indices agreeing;
    for (const int k : agreeing_with(*best)) agreeing.push_back(rows[static_cast<std::size_t>(k)]);
    if (agreeing.size() < 3) return std::nullopt;
    return stage_four(agreeing, *best);
  }

  RigidTransform stage_four(Indices rows, RigidTransform pose) const {
    std::vector<double> w(rows.size(), 1);
    double alpha = 0, last = 0;
    for (int round = 0; round <= 100; ++round) {
      const auto next = fit(rows, w);
      if (!next) break;
      pose = *next;
      double cost = 0, largest = 0;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        cost += w[k] * std::pow(residual(pose, rows[k]), 2);
        largest = std::max(largest, residual(pose, rows[k]));
      }
      alpha = round == 0 ? largest : alpha / 1.3;
      if (alpha < m_.resolution || (round > 0 && std::abs(cost - last) < 1e-4 * last)) break;
      last = cost;
      Indices left;
      w.clear();
      for (const int i : rows) {
        const double e = residual(pose, i);
        if (e > 3 * alpha) continue;
        left.push_back(i);
        w.push_back(alpha * alpha / (alpha * alpha + e * e));
      }
      rows = left;
    }
    return pose;
  }

  const CorrespondenceSet& m_;
  const TcfOptions& o_;
  const int n_;
  const double t_;
  RandomStream random_;
  Eigen::MatrixXi f_;
};

}  // namespace

Selection tcf(const CorrespondenceSet& matches, const TcfOptions& options) {
  if (matches.size() < 3) return {};
  return {Tcf(matches, options).run()};
}

}  // namespace corral::reference
