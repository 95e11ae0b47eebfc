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

std::vector<std::string> methods_with_numbers(const ExperimentTable& table, const Measure& measure) {
  std::vector<std::string> methods;
  for (const std::string& method : table.info.methods) {
    const auto has_numbers = [&](const LevelTable& level) {
      const RowNumbers* column = level.column(measure, method);
      return column && present_in(*column) > 0;
    };
    if (std::any_of(table.levels.begin(), table.levels.end(), has_numbers)) methods.push_back(method);
  }
  return methods;
}

/// The mean number of each pair over the levels where it has one.
std::map<std::string, double> means_of_pairs(const ExperimentTable& table, const std::string& method,
                                             const Measure& measure) {
  std::map<std::string, std::vector<double>> numbers;
  for (const LevelTable& level : table.levels) {
    const RowNumbers* column = level.column(measure, method);
    for (std::size_t row = 0; column && row < column->size(); ++row)
      if (!std::isnan((*column)[row])) numbers[level.pairs[row]].push_back((*column)[row]);
  }
  std::map<std::string, double> means;
  for (const auto& [pair, values] : numbers) means[pair] = mean_of(values);
  return means;
}

/// scores[method][pair] on the pairs that all methods have.
std::vector<std::vector<double>> common_scores(const ExperimentTable& table, const std::vector<std::string>& methods,
                                               const Measure& measure) {
  std::vector<std::map<std::string, double>> means;
  for (const std::string& method : methods) means.push_back(means_of_pairs(table, method, measure));
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
                                   const Measure& measure) {
  std::vector<MethodPair> tests;
  std::vector<double> p;
  for (std::size_t a = 0; a < scores.size(); ++a)
    for (std::size_t b = a + 1; b < scores.size(); ++b) {
      MethodPair test{comparison.methods[a], comparison.methods[b], {}, 1, 1, true};
      std::vector<double> differences;
      for (std::size_t i = 0; i < scores[a].size(); ++i) differences.push_back(scores[a][i] - scores[b][i]);
      test.difference = bootstrap_mean(differences, seed_of(comparison.experiment, test.first + " - " + test.second));
      if (measure.has(kYesOrNo)) {
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
                                   const Measure& measure) {
  std::vector<LevelMean> means;
  for (const LevelTable& level : table.levels)
    for (const std::string& method : methods)
      if (const auto mean = level_mean(table.info.name, level, method, measure))
        means.push_back({level.level.label, method, present_in(*level.column(measure, method)), *mean});
  return means;
}

}  // namespace

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const Measure* measure : measures_with(kHeadline)) names.push_back(measure->word());
  std::sort(names.begin(), names.end());
  return names;
}

const Measure& metric_of(const std::string& name) {
  std::string accepted;
  for (const Measure* measure : measures_with(kHeadline)) {
    if (measure->word() == name) return *measure;
    accepted += (accepted.empty() ? "" : ", ") + measure->word();
  }
  throw InvalidInput("comparison", "metric", name, "one of " + accepted);
}

std::optional<MeanInterval> level_mean(const std::string& experiment, const LevelTable& level,
                                       const std::string& method, const Measure& measure) {
  const RowNumbers* column = level.column(measure, method);
  if (!column || present_in(*column) == 0) return std::nullopt;
  const std::vector<double> numbers = present(*column);
  return bootstrap_mean(numbers, seed_of(experiment, level.level.label + " " + method));
}

MethodComparison compare_methods(const ExperimentTable& table, const Measure& measure) {
  MethodComparison comparison;
  comparison.experiment = table.info.name;
  comparison.methods = methods_with_numbers(table, measure);
  comparison.levels = level_means(table, comparison.methods, measure);
  const std::vector<std::vector<double>> scores = common_scores(table, comparison.methods, measure);
  if (scores.size() < 2 || scores.front().empty()) return comparison;
  comparison.pairs = static_cast<int>(scores.front().size());
  for (std::size_t i = 0; i < scores.size(); ++i)
    comparison.means.push_back(bootstrap_mean(scores[i], seed_of(table.info.name, comparison.methods[i])));
  std::vector<std::vector<double>> goodness = scores;
  if (measure.better == Better::Smaller)
    for (std::vector<double>& of_method : goodness)
      for (double& score : of_method) score = -score;
  comparison.ranks = compare_ranks(goodness);
  comparison.tests = test_pairs(comparison, scores, measure);
  return comparison;
}

}  // namespace corral
