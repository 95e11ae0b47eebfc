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

using Scores = std::vector<std::vector<double>>;  // [method][pair]

MethodPair test_pair(const MethodRanks& ranks, std::size_t a, std::size_t b, const Scores& scores,
                     const Measure& measure) {
  MethodPair test{ranks.methods[a], ranks.methods[b], {}, 1, 1, true};
  std::vector<double> differences;
  for (std::size_t i = 0; i < scores[a].size(); ++i) differences.push_back(scores[a][i] - scores[b][i]);
  test.difference = bootstrap_mean(differences, seed_of(ranks.experiment, test.first + " - " + test.second));
  if (measure.has(kYesOrNo)) {
    const auto above = std::count_if(differences.begin(), differences.end(), [](double d) { return d > 0; });
    const auto below = std::count_if(differences.begin(), differences.end(), [](double d) { return d < 0; });
    test.p = mcnemar(static_cast<int>(above), static_cast<int>(below)).exact_p;
  } else {
    const WilcoxonTest wilcoxon = wilcoxon_signed_rank(differences);
    test.p = wilcoxon.p;
    test.is_exact = wilcoxon.is_exact;
  }
  return test;
}

std::vector<MethodPair> test_pairs(const MethodRanks& ranks, const Scores& scores, const Measure& measure,
                                   const ParallelFor& parallel_for) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < scores.size(); ++a)
    for (std::size_t b = a + 1; b < scores.size(); ++b) pairs.emplace_back(a, b);
  std::vector<MethodPair> tests(pairs.size());
  parallel_for(static_cast<int>(pairs.size()), [&](int i) {
    const auto place = static_cast<std::size_t>(i);
    tests[place] = test_pair(ranks, pairs[place].first, pairs[place].second, scores, measure);
  });
  std::vector<double> p;
  for (const MethodPair& test : tests) p.push_back(test.p);
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < tests.size(); ++i) tests[i].adjusted_p = adjusted[i];
  return tests;
}

std::vector<LevelMean> means_of_levels(const ExperimentTable& table, const std::vector<std::string>& methods,
                                       const Measure& measure, const ParallelFor& parallel_for) {
  const std::size_t count = table.levels.size() * methods.size();
  std::vector<std::optional<MeanInterval>> found(count);
  const auto level_of = [&](std::size_t i) -> const LevelTable& { return table.levels[i / methods.size()]; };
  const auto method_of = [&](std::size_t i) { return methods[i % methods.size()]; };
  parallel_for(static_cast<int>(count), [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    found[i] = level_means(table.info.name, level_of(i), method_of(i), {&measure}).front();
  });
  std::vector<LevelMean> means;
  for (std::size_t i = 0; i < count; ++i)
    if (found[i])
      means.push_back(
          {level_of(i).level.label, method_of(i), present_in(*level_of(i).column(measure, method_of(i))), *found[i]});
  return means;
}

/// Fills what is there without resamples.
void rank(MethodRanks& ranks, const Scores& scores, const Measure& measure) {
  if (scores.size() < 2 || scores.front().empty()) return;
  ranks.pairs = static_cast<int>(scores.front().size());
  Scores goodness = scores;
  if (measure.better == Better::Smaller)
    for (std::vector<double>& of_method : goodness)
      for (double& score : of_method) score = -score;
  ranks.ranks = compare_ranks(goodness);
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

std::vector<std::optional<MeanInterval>> level_means(const std::string& experiment, const LevelTable& level,
                                                     const std::string& method,
                                                     const std::vector<const Measure*>& measures) {
  std::vector<std::vector<double>> numbers;
  std::map<std::size_t, std::vector<std::size_t>> by_count;  // columns of as many numbers are drawn together
  for (const Measure* measure : measures) {
    const RowNumbers* column = level.column(*measure, method);
    numbers.push_back(column ? present(*column) : RowNumbers());
    if (!numbers.back().empty()) by_count[numbers.back().size()].push_back(numbers.size() - 1);
  }
  std::vector<std::optional<MeanInterval>> means(measures.size());
  for (const auto& [count, places] : by_count) {
    std::vector<std::vector<double>> columns;
    for (const std::size_t place : places) columns.push_back(std::move(numbers[place]));
    const auto intervals = bootstrap_means(columns, seed_of(experiment, level.level.label + " " + method));
    for (std::size_t i = 0; i < places.size(); ++i) means[places[i]] = intervals[i];
  }
  return means;
}

MethodRanks rank_methods(const ExperimentTable& table, const Measure& measure) {
  MethodRanks ranks{table.info.name, methods_with_numbers(table, measure), 0, {}};
  rank(ranks, common_scores(table, ranks.methods, measure), measure);
  return ranks;
}

MethodComparison compare_methods(const ExperimentTable& table, const Measure& measure,
                                 const ParallelFor& parallel_for) {
  MethodComparison comparison;
  comparison.experiment = table.info.name;
  comparison.methods = methods_with_numbers(table, measure);
  comparison.levels = means_of_levels(table, comparison.methods, measure, parallel_for);
  const Scores scores = common_scores(table, comparison.methods, measure);
  rank(comparison, scores, measure);
  if (comparison.pairs == 0) return comparison;
  for (std::size_t i = 0; i < scores.size(); ++i)
    comparison.means.push_back(bootstrap_mean(scores[i], seed_of(table.info.name, comparison.methods[i])));
  comparison.tests = test_pairs(comparison, scores, measure, parallel_for);
  return comparison;
}

}  // namespace corral
