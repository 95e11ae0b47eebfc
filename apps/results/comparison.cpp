// SPDX-License-Identifier: MIT
#include "apps/results/comparison.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {
namespace {

constexpr std::uint64_t kSeed = 1;

/// What is there of a column, of one level.
std::vector<double> present(const RowNumbers& column) {
  std::vector<double> numbers;
  for (const double number : column)
    if (!std::isnan(number)) numbers.push_back(number);
  return numbers;
}

std::vector<std::string> methods_with_numbers(const ExperimentTable& table, Metric metric) {
  std::vector<std::string> methods;
  for (const std::string& method : table.info.methods) {
    const auto has_numbers = [&](const LevelTable& level) {
      const auto found = level.methods.find(method);
      return found != level.methods.end() && !present(metric_column(found->second, metric)).empty();
    };
    if (std::any_of(table.levels.begin(), table.levels.end(), has_numbers)) methods.push_back(method);
  }
  return methods;
}

/// The mean number of each pair over the levels where it has one.
std::map<std::string, double> means_of_pairs(const ExperimentTable& table, const std::string& method, Metric metric) {
  std::map<std::string, std::vector<double>> numbers;
  for (const LevelTable& level : table.levels) {
    const auto found = level.methods.find(method);
    if (found == level.methods.end()) continue;
    const RowNumbers& column = metric_column(found->second, metric);
    for (std::size_t row = 0; row < column.size(); ++row)
      if (!std::isnan(column[row])) numbers[level.pairs[row]].push_back(column[row]);
  }
  std::map<std::string, double> means;
  for (const auto& [pair, values] : numbers) means[pair] = mean_of(values);
  return means;
}

/// scores[method][pair] on the pairs that all methods have.
std::vector<std::vector<double>> common_scores(const ExperimentTable& table, const std::vector<std::string>& methods,
                                               Metric metric) {
  std::vector<std::map<std::string, double>> means;
  for (const std::string& method : methods) means.push_back(means_of_pairs(table, method, metric));
  std::vector<std::vector<double>> scores(methods.size());
  if (means.empty()) return scores;
  for (const auto& [pair, number] : means.front()) {
    const auto has_pair = [&name = pair](const auto& of_method) { return of_method.count(name) > 0; };
    if (!std::all_of(means.begin(), means.end(), has_pair)) continue;
    for (std::size_t i = 0; i < means.size(); ++i) scores[i].push_back(means[i].at(pair));
  }
  return scores;
}

std::uint64_t seed_of(const std::string& experiment, const std::string& what) {
  return derive_seed(derive_seed(kSeed, experiment), what);
}

std::vector<MethodPair> test_pairs(const MethodComparison& comparison, const std::vector<std::vector<double>>& scores,
                                   Metric metric) {
  std::vector<MethodPair> tests;
  std::vector<double> p;
  for (std::size_t a = 0; a < scores.size(); ++a)
    for (std::size_t b = a + 1; b < scores.size(); ++b) {
      MethodPair test{comparison.methods[a], comparison.methods[b], {}, 1, 1, true};
      std::vector<double> differences;
      for (std::size_t i = 0; i < scores[a].size(); ++i) differences.push_back(scores[a][i] - scores[b][i]);
      test.difference = bootstrap_mean(differences, seed_of(comparison.experiment, test.first + " - " + test.second));
      if (metric == Metric::Success) {
        const auto above = std::count_if(differences.begin(), differences.end(), [](double d) { return d > 0; });
        const auto below = std::count_if(differences.begin(), differences.end(), [](double d) { return d < 0; });
        test.p = mcnemar(static_cast<int>(above), static_cast<int>(below)).exact_p;
      } else {
        const WilcoxonTest wilcoxon = wilcoxon_signed_rank(differences);
        test.p = wilcoxon.p;
        test.is_exact = wilcoxon.is_exact;
      }
      tests.push_back(test);
      p.push_back(test.p);
    }
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < tests.size(); ++i) tests[i].adjusted_p = adjusted[i];
  return tests;
}

std::vector<LevelMean> level_means(const ExperimentTable& table, const std::vector<std::string>& methods,
                                   Metric metric) {
  std::vector<LevelMean> means;
  for (const LevelTable& level : table.levels)
    for (const std::string& method : methods)
      if (const auto mean = level_mean(table.info.name, level, method, metric))
        means.push_back(
            {level.level.label, method, present_in(metric_column(level.methods.at(method), metric)), *mean});
  return means;
}

}  // namespace

const std::vector<std::string>& metric_names() {
  static const std::vector<std::string> names = {"f1", "precision", "recall", "success"};
  return names;
}

Metric metric_of(const std::string& name) {
  const auto found = std::find(metric_names().begin(), metric_names().end(), name);
  if (found == metric_names().end())
    throw InvalidInput("comparison", "metric", name, "f1, precision, recall or success");
  return static_cast<Metric>(found - metric_names().begin());
}

const RowNumbers& metric_column(const MethodColumns& columns, Metric metric) {
  switch (metric) {
    case Metric::Precision:
      return columns.precision;
    case Metric::Recall:
      return columns.recall;
    case Metric::Success:
      return columns.success;
    default:
      return columns.f1;
  }
}

std::optional<MeanInterval> level_mean(const std::string& experiment, const LevelTable& level,
                                       const std::string& method, Metric metric) {
  const auto found = level.methods.find(method);
  if (found == level.methods.end()) return std::nullopt;
  const std::vector<double> numbers = present(metric_column(found->second, metric));
  if (numbers.empty()) return std::nullopt;
  return bootstrap_mean(numbers, seed_of(experiment, level.level.label + " " + method));
}

MethodComparison compare_methods(const ExperimentTable& table, Metric metric) {
  MethodComparison comparison;
  comparison.experiment = table.info.name;
  comparison.methods = methods_with_numbers(table, metric);
  comparison.levels = level_means(table, comparison.methods, metric);
  const std::vector<std::vector<double>> scores = common_scores(table, comparison.methods, metric);
  if (scores.size() < 2 || scores.front().empty()) return comparison;
  comparison.pairs = static_cast<int>(scores.front().size());
  for (std::size_t i = 0; i < scores.size(); ++i)
    comparison.means.push_back(bootstrap_mean(scores[i], seed_of(table.info.name, comparison.methods[i])));
  comparison.ranks = compare_ranks(scores);
  comparison.tests = test_pairs(comparison, scores, metric);
  return comparison;
}

}  // namespace corral
