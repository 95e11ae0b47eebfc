// SPDX-License-Identifier: MIT
#include "grouping/spectral.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grouping/columns/compatibility.h"
#include "grouping/columns/filter.h"
#include "grouping/graph/compatibility_graph.h"
#include "grouping/graph/leading_entry.h"

namespace corral {
namespace {

constexpr double kTie = 1e-9;
constexpr int kNobody = -1;
constexpr std::size_t kMany = 16;  // nodes whose columns are subtracted together

/// r(i,j) where it reaches `similarity`, else 0; 1 on the diagonal.
Eigen::MatrixXd weighted_matrix(const CorrespondenceSet& matches, double similarity) {
  const int rows = matches.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(rows, rows);
  for (int i = 0; i < rows; ++i)
    for (int j = i + 1; j < rows; ++j) {
      const PairDistances distances = pair_distances(matches, i, j);
      const double ratio = rigidity_ratio(distances.source, distances.target);
      matrix(i, j) = matrix(j, i) = ratio >= similarity ? ratio : 0;
    }
  return matrix;
}

/// The remaining matches, neither accepted nor in conflict with an accepted one, as nodes of a graph. From time to time the
/// graph is renumbered to hold only these.
class Alive {
 public:
  Alive(std::unique_ptr<GraphMatrix> graph, bool is_binary)
      : graph_(std::move(graph)),
        is_binary_(is_binary),
        rows_(static_cast<std::size_t>(graph_->size())),
        takes_part_(Eigen::VectorXd::Ones(graph_->size())),
        degrees_(graph_->degrees()),
        leading_(degrees_),
        sum_of_squares_(graph_->sum_of_squares()),
        count_(graph_->size()) {
    std::iota(rows_.begin(), rows_.end(), 0);
  }

  /// Whether any two matches are compatible.
  bool has_edges() const { return (degrees_.array() > 1).any(); }

  /// Computes the eigenvector of all.
  void start() { entries_ = principal_eigenvector(*graph_); }

  /// The node of the largest entry of the last eigenvector, the first of those within kTie; none if the largest is not above
  /// kTie.
  int largest() const {
    const double most = count_ > 0 ? entries_.maxCoeff() : 0;
    if (!(most > kTie)) return kNobody;
    int node = 0;
    while (!(takes_part_(node) > 0 && entries_(node) >= most - kTie)) ++node;
    return node;
  }

  /// The node of the largest entry in the eigenvector of those alive, computed as exactly as that needs.
  int choose() {
    const int obvious = compatible_with_all();
    if (obvious != kNobody || count_ == 0) return obvious;
    const int leader = leading_.find({*graph_, takes_part_, degrees_, sum_of_squares_, count_, is_binary_}, kTie);
    if (leader != LeadingEntry::kUncertain) return leader;
    renumber();
    start();
    leading_.restart(entries_);
    return largest();
  }

  /// Takes a match and those in conflict with it out of the graph. Returns its row in the table.
  int accept(int chosen) {
    const int row = rows_[static_cast<std::size_t>(chosen)];
    graph_->get_column(chosen, column_);
    Indices leaving;
    for (int node = 0; node < takes_part_.size(); ++node)
      if (takes_part_(node) > 0 && (node == chosen || !(column_(node) > 0))) leaving.push_back(node);
    if (is_binary_ && leaving.size() > kMany)
      remove_together(leaving);
    else
      for (const int node : leaving) remove(node);
    if (4 * count_ < 3 * graph_->size()) renumber();
    return row;
  }

 private:
  /// The first node that is compatible with all others. Where M has only entries 0 and 1 it is the one that choose() looks
  /// for: x_f = S / l, with S the sum of all entries and l the eigenvalue. A node that is not compatible with all has
  /// x_i = (S - the entries of the others) / l and lacks at least one x_k. That k has x_k >= x_f / (l - 1), for it is
  /// compatible with f and with itself; and x_k >= (S - (count - degree) x_f) / l, for no entry exceeds that of f. With
  /// x_f >= count^(-1/2) and l between the mean degree and count, the entry of f exceeds all others by at least count^(-5/2),
  /// or (mean degree - count + least degree) times that.
  int compatible_with_all() const {
    if (!is_binary_ || count_ == 0) return kNobody;
    const double least = (takes_part_.array() > 0).select(degrees_.array(), count_).minCoeff();
    const double factor = std::max(1.0, sum_of_squares_ / count_ - count_ + least);
    if (!(factor * std::pow(count_, -2.5) > 2 * kTie)) return kNobody;
    int node = 0;
    while (node < takes_part_.size() && !(takes_part_(node) > 0 && degrees_(node) == count_)) ++node;
    return node < takes_part_.size() ? node : kNobody;
  }

  void remove(int node) {
    graph_->get_column(node, column_);
    const double squares = is_binary_ ? degrees_(node) : column_.cwiseProduct(takes_part_).squaredNorm();
    sum_of_squares_ -= 2 * squares - column_(node) * column_(node);
    if (is_binary_)
      degrees_ -= column_;
    else
      degrees_ -= (column_.array() > 0).cast<double>().matrix();
    leading_.remove(node, column_);
    takes_part_(node) = 0;
    if (entries_.size() > 0) entries_(node) = 0;
    --count_;
  }

  /// The same for many nodes of a graph of bits, whose sums are whole numbers.
  void remove_together(const Indices& nodes) {
    Eigen::VectorXd ones = Eigen::VectorXd::Zero(takes_part_.size());
    ones(nodes).setOnes();
    graph_->round_and_multiply(ones, column_);
    degrees_ -= column_;
    leading_.remove(nodes, *graph_);
    takes_part_(nodes).setZero();
    if (entries_.size() > 0) entries_(nodes).setZero();
    count_ -= static_cast<int>(nodes.size());
    sum_of_squares_ = degrees_.dot(takes_part_);
  }

  void renumber() {
    Indices nodes;
    for (int node = 0; node < takes_part_.size(); ++node)
      if (takes_part_(node) > 0) nodes.push_back(node);
    graph_->keep(nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i) rows_[i] = rows_[static_cast<std::size_t>(nodes[i])];
    rows_.resize(nodes.size());
    leading_.renumber(nodes);
    if (entries_.size() > 0) entries_ = Eigen::VectorXd(entries_(nodes));
    degrees_ = Eigen::VectorXd(degrees_(nodes));
    takes_part_ = Eigen::VectorXd::Ones(graph_->size());
    sum_of_squares_ = graph_->sum_of_squares();  // without the rounding of the subtractions since
  }

  std::unique_ptr<GraphMatrix> graph_;
  bool is_binary_;              ///< no entries but 0 and 1
  Indices rows_;                ///< of the table, by node
  Eigen::VectorXd takes_part_;  ///< 1 or 0, by node
  Eigen::VectorXd entries_;     ///< of the last eigenvector that was computed, by node; 0 for those that left since
  Eigen::VectorXd degrees_;     ///< number of compatible remaining matches, with itself, by node
  LeadingEntry leading_;        ///< in the eigenvector of the remaining matches
  double sum_of_squares_;       ///< of the matrix of the remaining matches
  int count_;                   ///< of the remaining matches
  Eigen::VectorXd column_;
};

}  // namespace

GroupingResult group_by_spectral(const CorrespondenceSet& matches, const SpectralOptions& options) {
  validate_options(options, "st");
  matches.validate();
  GroupingResult result;
  std::unique_ptr<GraphMatrix> graph;
  if (options.weighted)
    graph = std::make_unique<DenseGraph>(weighted_matrix(matches, options.similarity));
  else
    graph = std::make_unique<CompatibilityGraph>(matches, options.similarity);
  Alive alive(std::move(graph), !options.weighted);
  if (!alive.has_edges()) return result;  // no two matches are compatible
  if (options.once) alive.start();
  const auto next = [&] { return options.once ? alive.largest() : alive.choose(); };
  for (int node = next(); node != kNobody; node = next()) result.selected.push_back(alive.accept(node));
  std::sort(result.selected.begin(), result.selected.end());
  return result;
}

double working_memory(int matches, const SpectralOptions& options) {
  // The graph, and a copy while a part of it is solved; then columns of doubles, most of them the
  // basis of the eigenvector.
  const double n = matches, graph = options.weighted ? 8 * n * n : CompatibilityGraph::memory(matches);
  return 2 * graph + 600 * n + 65536;
}

}  // namespace corral
