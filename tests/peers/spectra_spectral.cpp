// SPDX-License-Identifier: MIT
#include "tests/peers/spectra_spectral.h"

#include <Spectra/MatOp/DenseSymMatProd.h>
#include <Spectra/SymEigsSolver.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <numeric>

namespace corral::peers {
namespace {

constexpr int kIterations = 1000;
constexpr double kTolerance = 1e-10;
constexpr double kTie = 1e-9;

Eigen::MatrixXd compatibility_graph(const CorrespondenceSet& matches, double similarity) {
  Eigen::MatrixXd graph = Eigen::MatrixXd::Identity(matches.size(), matches.size());
  for (int i = 0; i < matches.size(); ++i)
    for (int j = i + 1; j < matches.size(); ++j) {
      const double source = (matches.source_points.row(i) - matches.source_points.row(j)).norm();
      const double target = (matches.target_points.row(i) - matches.target_points.row(j)).norm();
      const double larger = std::max(source, target);
      graph(i, j) = graph(j, i) = larger > 0 && std::min(source, target) / larger >= similarity;
    }
  return graph;
}

Eigen::VectorXd principal_vector(const Eigen::MatrixXd& graph) {
  if (graph.rows() > 3) {  // as many as it can iterate on
    Spectra::DenseSymMatProd<double> product(graph);
    Spectra::SymEigsSolver<decltype(product)> solver(product, 1, std::min<Eigen::Index>(graph.rows(), 20));
    solver.init();
    solver.compute(Spectra::SortRule::LargestAlge, kIterations, kTolerance);
    if (solver.info() == Spectra::CompInfo::Successful) return solver.eigenvectors(1).col(0).cwiseAbs();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(graph);
  return solver.eigenvectors().rightCols<1>().cwiseAbs();
}

}  // namespace

Indices group_with_spectra(const CorrespondenceSet& matches, double similarity) {
  const Eigen::MatrixXd graph = compatibility_graph(matches, similarity);
  Indices alive(static_cast<std::size_t>(matches.size())), accepted;
  std::iota(alive.begin(), alive.end(), 0);
  while (!alive.empty()) {
    const Eigen::VectorXd x = principal_vector(graph(alive, alive));
    const double least = x.maxCoeff() - kTie;
    const auto best = std::find_if(x.data(), x.data() + x.size(), [&](double entry) { return entry >= least; });
    const int chosen = alive[static_cast<std::size_t>(best - x.data())];
    accepted.push_back(chosen);
    const auto conflicts = [&](int row) { return row == chosen || graph(chosen, row) == 0; };
    alive.erase(std::remove_if(alive.begin(), alive.end(), conflicts), alive.end());
  }
  std::sort(accepted.begin(), accepted.end());
  return accepted;
}

}  // namespace corral::peers
