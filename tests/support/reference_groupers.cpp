// SPDX-License-Identifier: MIT
#include "tests/support/reference_groupers.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
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

/// Rows 0 .. count-1 by ascending key, ties by row.
Indices rows_by(const std::vector<double>& keys) {
  std::vector<std::pair<double, int>> pairs;
  for (std::size_t i = 0; i < keys.size(); ++i) pairs.emplace_back(keys[i], static_cast<int>(i));
  std::sort(pairs.begin(), pairs.end());
  Indices rows;
  for (const auto& pair : pairs) rows.push_back(pair.second);
  return rows;
}

/// n1 n2 (m1 - m2)^2 with the first `cut` of the ascending values as the lower class.
double between_class_variance(const std::vector<double>& values, std::size_t cut) {
  double low = 0, high = 0;
  for (std::size_t i = 0; i < values.size(); ++i) (i < cut ? low : high) += values[i];
  const auto n1 = static_cast<double>(cut), n2 = static_cast<double>(values.size() - cut);
  return n1 * n2 * (low / n1 - high / n2) * (low / n1 - high / n2);
}

/// Size of the lower class at the best gap of the ascending values (ties: the lowest); 0 if all are equal.
std::size_t best_cut(const std::vector<double>& values) {
  std::size_t best = 0;
  for (std::size_t cut = 1; cut < values.size(); ++cut)
    if (values[cut - 1] < values[cut] &&
        (best == 0 || between_class_variance(values, cut) > between_class_variance(values, best)))
      best = cut;
  return best;
}

/// The part of the graph that `start` belongs to, ascending.
Indices connected_part(const Eigen::MatrixXd& matrix, int start) {
  Indices part{start};
  for (std::size_t next = 0; next < part.size(); ++next)
    for (int j = 0; j < matrix.rows(); ++j)
      if (matrix(part[next], j) > 0 && std::find(part.begin(), part.end(), j) == part.end()) part.push_back(j);
  std::sort(part.begin(), part.end());
  return part;
}

/// Dense solution, part by part, so that equal eigenvalues of two parts do not mix their vectors.
Eigen::VectorXd principal_vector(const Eigen::MatrixXd& matrix) {
  Eigen::VectorXd best = Eigen::VectorXd::Zero(matrix.rows());
  std::vector<bool> seen(static_cast<std::size_t>(matrix.rows()), false);
  double best_value = 0;
  for (int start = 0; start < matrix.rows(); ++start) {
    if (seen[static_cast<std::size_t>(start)]) continue;
    const Indices part = connected_part(matrix, start);
    for (const int row : part) seen[static_cast<std::size_t>(row)] = true;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix(part, part));
    const double value = solver.eigenvalues()(solver.eigenvalues().size() - 1);
    if (!(value > best_value * (1 + 1e-9))) continue;
    best_value = value;
    best.setZero();
    best(part) = solver.eigenvectors().rightCols<1>().cwiseAbs();
  }
  return best;
}

}  // namespace

Indices rows_by_otsu(const std::vector<double>& scores, OtsuRule rule) {
  const auto count = static_cast<int>(scores.size());
  if (count == 0) return {};
  const double smallest = *std::min_element(scores.begin(), scores.end());
  const double largest = *std::max_element(scores.begin(), scores.end());
  const int bins = rule == OtsuRule::Bins100 ? 100 : static_cast<int>(std::lround(std::sqrt(count)));
  std::vector<double> values = scores;  // what is cut in two: the scores, or the numbers of their bins
  for (double& value : values) {
    if (rule == OtsuRule::Exact || smallest == largest) continue;
    const double place = rule == OtsuRule::Bins100 ? (value - smallest) / (largest - smallest) : value;
    value = std::min(std::max(std::floor(place * bins), 0.0), bins - 1.0);
  }
  std::vector<double> ascending = values;
  std::sort(ascending.begin(), ascending.end());
  const std::size_t cut = best_cut(ascending);
  Indices selected;
  for (int row = 0; row < count; ++row) {
    const auto i = static_cast<std::size_t>(row);
    bool keep = true;
    if (cut > 0 && rule == OtsuRule::Exact) keep = scores[i] >= (ascending[cut - 1] + ascending[cut]) / 2;
    if (cut > 0 && rule == OtsuRule::Bins100) keep = values[i] >= ascending[cut - 1];
    if (cut > 0 && rule == OtsuRule::Covis) keep = scores[i] > ascending[cut - 1] / (bins - 1);
    if (keep) selected.push_back(row);
  }
  return selected;
}

Indices similarity_score(const CorrespondenceSet& matches, const SimilarityScoreOptions& options) {
  std::vector<double> scores;
  for (int i = 0; i < matches.size(); ++i) scores.push_back(1 - matches.feature_distance(i));
  return rows_by_otsu(scores, options.otsu);
}

Indices nearest_neighbor_ratio(const CorrespondenceSet& matches, const NearestNeighborRatioOptions& options) {
  Indices selected;
  for (int i = 0; i < matches.size(); ++i) {
    if (matches.second_feature_distance(i) <= 0) continue;
    const double ratio = matches.feature_distance(i) / matches.second_feature_distance(i);
    if (options.ratio == RatioRule::Lowe ? ratio <= options.threshold : 1 - ratio >= options.threshold)
      selected.push_back(i);
  }
  return selected;
}

Indices spectral(const CorrespondenceSet& matches, const SpectralOptions& options) {
  const int count = matches.size();
  Eigen::MatrixXd graph = Eigen::MatrixXd::Identity(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      if (i != j && rigidity(matches, i, j) >= options.similarity)
        graph(i, j) = options.weighted ? rigidity(matches, i, j) : 1;
  if (graph.sum() == count) return {};  // nobody is compatible with anybody

  Indices alive, selected;
  for (int i = 0; i < count; ++i) alive.push_back(i);
  const Eigen::VectorXd whole = options.once ? principal_vector(graph) : Eigen::VectorXd();
  while (!alive.empty()) {
    const Eigen::VectorXd x = options.once ? Eigen::VectorXd(whole(alive)) : principal_vector(graph(alive, alive));
    if (x.maxCoeff() <= 1e-9) break;
    Eigen::Index best = 0;
    while (x(best) < x.maxCoeff() - 1e-9) ++best;
    const int accepted = alive[static_cast<std::size_t>(best)];
    selected.push_back(accepted);
    Indices rest;
    for (const int j : alive)
      if (j != accepted && graph(accepted, j) > 0) rest.push_back(j);
    alive = rest;
  }
  std::sort(selected.begin(), selected.end());
  return selected;
}

Indices geometric_consistency(const CorrespondenceSet& matches, const GeometricConsistencyOptions& options) {
  const auto agree = [&](int i, int j) {
    return std::abs(distance(matches.source_points, i, j) - distance(matches.target_points, i, j)) <
           options.tolerance_pr * matches.resolution;
  };
  const bool star = options.cluster == ClusterRule::Star;
  std::vector<double> keys(static_cast<std::size_t>(matches.size()), 0.0);
  for (int i = 0; i < matches.size() && !star; ++i) keys[static_cast<std::size_t>(i)] = matches.feature_distance(i);
  const Indices order = rows_by(keys);
  std::vector<bool> taken(keys.size(), false);
  Indices best;
  for (const int seed : order) {
    if (taken[static_cast<std::size_t>(seed)]) continue;
    Indices cluster{seed};
    for (const int j : order) {
      if (j == seed || taken[static_cast<std::size_t>(j)]) continue;
      bool fits = true;
      for (const int member : cluster) fits = fits && agree(star ? seed : member, j);
      if (fits) cluster.push_back(j);
    }
    if (!star && cluster.size() <= 3) continue;
    for (const int member : cluster) taken[static_cast<std::size_t>(member)] = !star;
    if (cluster.size() > best.size()) best = cluster;
  }
  std::sort(best.begin(), best.end());
  return best;
}

Indices hough_voting(const CorrespondenceSet& matches, const HoughVotingOptions& options) {
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
  Indices selected = voters[peak];
  for (std::size_t axis = 0; axis < 3 && box; ++axis) {
    for (const int step : {-1, 1}) {
      Cell neighbour = peak;
      neighbour[axis] += step;
      selected.insert(selected.end(), voters[neighbour].begin(), voters[neighbour].end());
    }
  }
  std::sort(selected.begin(), selected.end());
  return selected;
}

Indices search_of_inliers(const CorrespondenceSet& matches, const SearchOfInliersOptions& options) {
  const int count = matches.size();
  if (count <= 2) return count == 2 ? Indices{0, 1} : Indices(static_cast<std::size_t>(count), 0);
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

  std::vector<int> local_voters, local_votes;
  std::vector<double> global_order;  // ascending: the best voter first
  for (int c = 0; c < count; ++c) {
    std::vector<double> far;
    for (int j = 0; j < count; ++j) far.push_back(j == c ? INFINITY : distance(matches.source_points, c, j));
    Indices near = rows_by(far);
    near.resize(static_cast<std::size_t>(std::min(options.voters, count - 1)));
    int voters = 0, votes = 0;
    for (const int j : near) {
      if (!in_ratio_set[static_cast<std::size_t>(j)]) continue;
      ++voters;
      if (rigid(c, j)) ++votes;
    }
    local_voters.push_back(voters);
    local_votes.push_back(votes);
    const double local_score = voters > 0 ? static_cast<double>(votes) / voters : 0;
    global_order.push_back(covis ? -local_score : -distinctiveness[static_cast<std::size_t>(c)]);
  }
  Indices best = rows_by(global_order);
  best.resize(static_cast<std::size_t>(std::min(options.voters, count)));

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
  return rows_by_otsu(scores, options.otsu);
}

}  // namespace corral::reference
