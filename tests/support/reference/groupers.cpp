// SPDX-License-Identifier: MIT
#include "tests/support/reference/groupers.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace corral::reference {
namespace {

double length(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

double distance(const Points& points, int i, int j) {
  return length(points(i, 0) - points(j, 0), points(i, 1) - points(j, 1), points(i, 2) - points(j, 2));
}

double rigidity(const CorrespondenceSet& matches, int i, int j) {
  const double source = distance(matches.source_points, i, j);
  const double target = distance(matches.target_points, i, j);
  if (source == 0 || target == 0) return 0;
  return source < target ? source / target : target / source;
}

bool has_frame(const Eigen::Matrix3d& frame) {
  return (frame * frame.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-4 &&
         frame.determinant() > 0;
}

bool has_frames(const CorrespondenceSet& matches, int row) {
  const auto i = static_cast<std::size_t>(row);
  return has_frame(matches.source_frames[i]) && has_frame(matches.target_frames[i]);
}

Indices all_rows(int count) {
  Indices rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// Rows 0 .. count-1 by ascending key, ties by row.
Indices rows_by(const std::vector<double>& keys) {
  std::vector<std::pair<double, int>> pairs;
  for (std::size_t i = 0; i < keys.size(); ++i) pairs.emplace_back(keys[i], static_cast<int>(i));
  std::sort(pairs.begin(), pairs.end());
  Indices rows;
  for (const auto& pair : pairs) rows.push_back(pair.second);
  return rows;
}

bool has_equals(const std::vector<double>& keys) {
  return std::set<double>(keys.begin(), keys.end()).size() < keys.size();
}

/// The `count` rows with the smallest keys; notes whether one of equals was left out.
Indices first_rows(const std::vector<double>& keys, int count, bool& tied) {
  Indices rows = rows_by(keys);
  const auto end = static_cast<std::size_t>(count);
  if (end < rows.size())
    tied = tied || keys[static_cast<std::size_t>(rows[end - 1])] == keys[static_cast<std::size_t>(rows[end])];
  rows.resize(std::min(end, rows.size()));
  return rows;
}

/// The part of the graph that `start` belongs to, ascending.
Indices connected_part(const Eigen::MatrixXd& matrix, int start) {
  Indices part{start};
  std::vector<bool> is_part(static_cast<std::size_t>(matrix.rows()), false);
  is_part[static_cast<std::size_t>(start)] = true;
  for (std::size_t next = 0; next < part.size(); ++next)
    for (int j = 0; j < matrix.rows(); ++j)
      if (matrix(part[next], j) > 0 && !is_part[static_cast<std::size_t>(j)])
        is_part[static_cast<std::size_t>(j)] = true, part.push_back(j);
  std::sort(part.begin(), part.end());
  return part;
}

/// The principal eigenvector, and whether two parts have the same eigenvalue.
struct Principal {
  Eigen::VectorXd vector;
  bool tied = false;
};

/// Dense solution, part by part, so that equal eigenvalues of two parts do not mix their vectors.
Principal principal_vector(const Eigen::MatrixXd& matrix) {
  Principal best{Eigen::VectorXd::Zero(matrix.rows())};
  std::vector<bool> seen(static_cast<std::size_t>(matrix.rows()), false);
  double best_value = 0;
  for (int start = 0; start < matrix.rows(); ++start) {
    if (seen[static_cast<std::size_t>(start)]) continue;
    const Indices part = connected_part(matrix, start);
    for (const int row : part) seen[static_cast<std::size_t>(row)] = true;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix(part, part));
    const double value = solver.eigenvalues()(solver.eigenvalues().size() - 1);
    if (value > best_value * (1 + 1e-9)) {
      best = {Eigen::VectorXd::Zero(matrix.rows())};
      best.vector(part) = solver.eigenvectors().rightCols<1>().cwiseAbs();
      best_value = value;
    } else if (value > best_value * (1 - 1e-9)) {
      best.tied = true;
    }
  }
  return best;
}

/// Compatible, and alike to all others alive: whichever is accepted first, both are in the end.
bool are_twins(const Eigen::MatrixXd& graph, const Indices& alive, int i, int j) {
  return graph(i, j) > 0 &&
         std::all_of(alive.begin(), alive.end(), [&](int k) { return k == i || k == j || graph(i, k) == graph(j, k); });
}

}  // namespace

Selection spectral(const CorrespondenceSet& matches, const SpectralOptions& options) {
  const int count = matches.size();
  Eigen::MatrixXd graph = Eigen::MatrixXd::Identity(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      if (i != j && rigidity(matches, i, j) >= options.similarity)
        graph(i, j) = options.weighted ? rigidity(matches, i, j) : 1;
  if (graph.sum() == count) return {};  // nobody is compatible with anybody

  Selection selection;
  Indices alive = all_rows(count);
  const Principal whole = options.once ? principal_vector(graph) : Principal();
  while (!alive.empty()) {
    const Principal principal =
        options.once ? Principal{whole.vector(alive), whole.tied} : principal_vector(graph(alive, alive));
    const Eigen::VectorXd& x = principal.vector;
    if (x.maxCoeff() <= 1e-9) break;
    Indices largest;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (x(i) >= x.maxCoeff() - 1e-9) largest.push_back(alive[static_cast<std::size_t>(i)]);
    const int accepted = largest.front();
    selection.rows.push_back(accepted);
    selection.tied = selection.tied || principal.tied;
    for (const int other : largest)
      if (other != accepted && !are_twins(graph, alive, accepted, other)) selection.tied = true;
    Indices rest;
    for (const int j : alive)
      if (j != accepted && graph(accepted, j) > 0) rest.push_back(j);
    alive = rest;
  }
  std::sort(selection.rows.begin(), selection.rows.end());
  return selection;
}

Selection geometric_consistency(const CorrespondenceSet& matches, const GeometricConsistencyOptions& options) {
  const auto agree = [&](int i, int j) {
    return std::abs(distance(matches.source_points, i, j) - distance(matches.target_points, i, j)) <
           options.tolerance_pr * matches.resolution;
  };
  const bool star = options.cluster == ClusterRule::Star;
  std::vector<double> keys(static_cast<std::size_t>(matches.size()), 0.0);
  for (int i = 0; i < matches.size() && !star; ++i) keys[static_cast<std::size_t>(i)] = matches.feature_distance(i);
  const Indices order = rows_by(keys);
  std::vector<bool> taken(keys.size(), false);
  Selection best;
  for (const int seed : order) {
    if (taken[static_cast<std::size_t>(seed)]) continue;
    Indices cluster{seed};
    for (const int j : order) {
      if (j == seed || taken[static_cast<std::size_t>(j)]) continue;
      const auto agrees = [&](int member) { return agree(member, j); };
      if (star ? agrees(seed) : std::all_of(cluster.begin(), cluster.end(), agrees)) cluster.push_back(j);
    }
    if (!star && cluster.size() <= 3) continue;
    for (const int member : cluster) taken[static_cast<std::size_t>(member)] = !star;
    std::sort(cluster.begin(), cluster.end());
    if (cluster.size() > best.rows.size())
      best = {cluster};
    else if (cluster.size() == best.rows.size() && cluster != best.rows)
      best.tied = true;
  }
  if (!star) best.tied = has_equals(keys);  // the order of the seeds settles everything else
  return best;
}

Selection hough_voting(const CorrespondenceSet& matches, const HoughVotingOptions& options) {
  const Eigen::Vector3d centroid = matches.source_centroid_or_mean();
  std::map<int, Eigen::Vector3d> votes;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (int i = 0; i < matches.size(); ++i) {
    if (!has_frames(matches, i)) continue;
    const auto row = static_cast<std::size_t>(i);
    const Eigen::Vector3d local = matches.source_frames[row] * (centroid - matches.source_points.row(i).transpose());
    votes[i] = matches.target_frames[row].transpose() * local + matches.target_points.row(i).transpose();
    low = low.cwiseMin(votes[i]);
    high = high.cwiseMax(votes[i]);
  }

  using Cell = std::array<double, 3>;  // whole numbers of any size; std::map visits them by x, then y, then z
  const bool box = options.cells == HoughCells::Box;
  const double farthest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  const double rounding = std::max(1e-6 * matches.resolution, 64 * std::numeric_limits<double>::epsilon() * farthest);
  const double side = 5 * matches.resolution;
  std::map<Cell, double> weight;
  std::map<Cell, Indices> voters;
  for (const auto& [row, vote] : votes) {
    for (int corner = 0; corner < (box ? 1 : 8); ++corner) {
      Cell cell{};
      double share = 1;
      for (int axis = 0; axis < 3; ++axis) {
        double& index = cell[static_cast<std::size_t>(axis)];
        const double offset = vote(axis) - low(axis), extent = high(axis) - low(axis);
        if (box) {
          index = extent > rounding ? std::min(options.bins - 1.0, std::floor(offset / (extent / options.bins))) : 0;
        } else {  // the two cells whose centres enclose the vote
          const double place = offset / side - 0.5;
          const bool upper = (corner >> axis) % 2 == 1;
          index = std::floor(place) + (upper ? 1 : 0);
          share *= upper ? place - std::floor(place) : 1 - (place - std::floor(place));
        }
      }
      if (share > 0) weight[cell] += share, voters[cell].push_back(row);
    }
  }

  double fullest = 0;
  Cell peak{};
  for (const auto& [cell, sum] : weight)
    if (sum > fullest) fullest = sum, peak = cell;
  Selection selection{voters[peak]};
  for (const auto& [cell, sum] : weight)
    if (sum > fullest * (1 - 1e-9) && voters[cell] != voters[peak]) selection.tied = true;
  for (std::size_t axis = 0; axis < 3 && box; ++axis) {
    for (const int step : {-1, 1}) {
      Cell neighbour = peak;
      neighbour[axis] += step;
      selection.rows.insert(selection.rows.end(), voters[neighbour].begin(), voters[neighbour].end());
    }
  }
  std::sort(selection.rows.begin(), selection.rows.end());
  return selection;
}

Selection search_of_inliers(const CorrespondenceSet& matches, const SearchOfInliersOptions& options) {
  const int count = matches.size();
  if (count <= 2) return {all_rows(count)};
  const bool covis = options.form == VotingForm::Covis;
  const auto rigid = [&](int i, int j) {
    const double r = rigidity(matches, i, j);
    return covis ? r >= options.similarity : r > options.similarity;
  };

  std::vector<double> distinctiveness;
  std::vector<bool> in_ratio_set;
  for (int i = 0; i < count; ++i) {
    const double d1 = matches.feature_distance(i), d2 = matches.second_feature_distance(i);
    distinctiveness.push_back(d2 > 0 ? 1 - d1 / d2 : 0);
    in_ratio_set.push_back(d2 > 0 && (covis ? d1 / d2 < 0.8 : d1 / d2 <= 0.8));
  }

  bool tied = false;
  std::vector<int> local_voters, local_votes;
  std::vector<double> global_order;  // ascending: the best voter first
  for (int c = 0; c < count; ++c) {
    std::vector<double> far;
    for (int j = 0; j < count; ++j) far.push_back(j == c ? INFINITY : distance(matches.source_points, c, j));
    int voters = 0, votes = 0;
    for (const int j : first_rows(far, std::min(options.voters, count - 1), tied)) {
      if (!in_ratio_set[static_cast<std::size_t>(j)]) continue;
      ++voters;
      if (rigid(c, j)) ++votes;
    }
    local_voters.push_back(voters);
    local_votes.push_back(votes);
    const double local_score = voters > 0 ? static_cast<double>(votes) / voters : 0;
    global_order.push_back(covis ? -local_score : -distinctiveness[static_cast<std::size_t>(c)]);
  }
  const Indices best = first_rows(global_order, options.voters, tied);

  std::vector<double> scores;
  for (int c = 0; c < count; ++c) {
    const auto row = static_cast<std::size_t>(c);
    int voters = local_voters[row], votes = local_votes[row];
    const Eigen::Matrix3d turn = matches.target_frames[row].transpose() * matches.source_frames[row];
    Eigen::Vector3d shift = matches.target_points.row(c).transpose() - turn * matches.source_points.row(c).transpose();
    if (options.form == VotingForm::Rotation) shift.setZero();
    for (const int j : best) {
      if (j == c) continue;
      ++voters;
      const Eigen::Vector3d carried = turn * matches.source_points.row(j).transpose() + shift;
      const double residual = (carried - matches.target_points.row(j).transpose()).norm();
      if (has_frames(matches, c) && rigid(c, j) && residual < options.tolerance_pr * matches.resolution) ++votes;
    }
    scores.push_back(voters > 0 ? static_cast<double>(votes) / voters : 0);
  }
  return {rows_by_otsu(scores, options.otsu), scores, tied};
}

}  // namespace corral::reference
