// SPDX-License-Identifier: MIT
#include "apps/claims/claim_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "apps/results/level_table.h"

namespace corral {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;

using Numbers = std::vector<double>;
using Kind = Operand::Kind;

bool any_missing(const Numbers& numbers) {
  return std::any_of(numbers.begin(), numbers.end(), [](double number) { return std::isnan(number); });
}

RuleOutcome outcome_of(double margin, bool or_equal) {
  if (std::abs(margin) < kRounding) margin = 0;
  return {or_equal ? margin >= 0 : margin > 0, margin};
}

/// The lesser margin decides; of equal ones the one that fails.
RuleOutcome worse(const RuleOutcome& a, const RuleOutcome& b) {
  if (std::isnan(a.margin) || std::isnan(b.margin)) return {false, std::numeric_limits<double>::quiet_NaN()};
  return {a.holds && b.holds, std::min(a.margin, b.margin)};
}

Numbers others_of(const Numbers& numbers, const std::vector<int>& without) {
  Numbers others;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (std::find(without.begin(), without.end(), static_cast<int>(i)) == without.end()) others.push_back(numbers[i]);
  return others;
}

double largest_of(const Numbers& numbers) {
  if (any_missing(numbers)) return std::numeric_limits<double>::quiet_NaN();
  return numbers.empty() ? -kUnbounded : *std::max_element(numbers.begin(), numbers.end());
}

double number_of(const Operand& operand, const Numbers& numbers, const std::vector<int>& left) {
  switch (operand.kind) {
    case Kind::Alone:
      return numbers.front();
    case Kind::Largest:
      return largest_of(numbers);
    case Kind::Median:
      return any_missing(numbers) ? std::numeric_limits<double>::quiet_NaN() : median_of(numbers);
    case Kind::Others:
      return largest_of(others_of(numbers, left));
    default: {
      double sum = 0;
      for (const int method : operand.methods) sum += numbers[static_cast<std::size_t>(method)];
      return sum / static_cast<double>(operand.methods.size());
    }
  }
}

RuleOutcome compare_sides(const Comparison& comparison, double left, double right) {
  return outcome_of(comparison.is_greater ? left - right : right - left, comparison.or_equal);
}

/// rank(m) <= k: the k-th best other does not beat m. rank(m) >= k: the (k - 1)-th best other does.
RuleOutcome compare_rank(const Comparison& comparison, Numbers numbers, const Scale& scale) {
  if (any_missing(numbers)) return {false, std::numeric_limits<double>::quiet_NaN()};
  if (scale.lower_is_better)
    for (double& number : numbers) number = -number;
  const std::vector<int>& method = comparison.left.methods;
  const double own = numbers[static_cast<std::size_t>(method.front())];
  Numbers others = others_of(numbers, method);
  std::sort(others.begin(), others.end(), std::greater<>());
  const double strict = comparison.or_equal ? 0 : 1;
  const auto bound = static_cast<int>(comparison.offset + (comparison.is_greater ? strict : -strict));
  const auto other = [&](int place) {  // from 1
    if (place < 1) return kUnbounded;
    return place > static_cast<int>(others.size()) ? -kUnbounded : others[static_cast<std::size_t>(place - 1)];
  };
  if (comparison.is_greater) return outcome_of(other(bound - 1) - own - scale.tau, false);
  return outcome_of(own + scale.tau - other(bound), true);
}

RuleOutcome compare(const Comparison& comparison, const Numbers& numbers, const Scale& scale) {
  if (comparison.left.kind == Kind::Rank) return compare_rank(comparison, numbers, scale);
  const auto right = [&](const std::vector<int>& left) {
    if (comparison.right.kind == Kind::Constant)
      return scale.is_logarithm ? std::log(comparison.offset) : comparison.offset;
    const double number = number_of(comparison.right, numbers, left);
    return (scale.is_logarithm ? number + std::log(comparison.factor) : comparison.factor * number) + comparison.offset;
  };
  if (comparison.left.kind != Kind::All)
    return compare_sides(comparison, number_of(comparison.left, numbers, {}), right(comparison.left.methods));
  RuleOutcome all{true, kUnbounded};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    all = worse(all, compare_sides(comparison, numbers[i], right({static_cast<int>(i)})));
  return all;
}

/// The members are those that follow the `after` largest others, and all else is smaller.
RuleOutcome test_set(const std::vector<int>& members, const Numbers& numbers, int after, double ties) {
  if (any_missing(numbers)) return {false, std::numeric_limits<double>::quiet_NaN()};
  double least = kUnbounded, most = -kUnbounded;
  for (const int member : members) {
    least = std::min(least, numbers[static_cast<std::size_t>(member)]);
    most = std::max(most, numbers[static_cast<std::size_t>(member)]);
  }
  Numbers others = others_of(numbers, members);
  std::sort(others.begin(), others.end(), std::greater<>());
  const auto split = static_cast<std::size_t>(after);
  double margin = kUnbounded;
  if (split > others.size()) return {false, -kUnbounded};
  if (split > 0) margin = others[split - 1] - most;
  if (split < others.size()) margin = std::min(margin, least - others[split]);
  return outcome_of(margin + ties, ties > 0);
}

}  // namespace

RuleOutcome test_numbers(const ClaimPart& part, const Numbers& numbers, const Scale& scale) {
  RuleOutcome outcome{true, kUnbounded};
  for (const Comparison& comparison : part.is) outcome = worse(outcome, compare(comparison, numbers, scale));
  const double ties = part.ties ? scale.tau : 0;
  if (!part.largest.empty()) outcome = worse(outcome, test_set(part.largest, numbers, part.after, ties));
  if (!part.smallest.empty()) {
    Numbers negated;
    for (const double number : numbers) negated.push_back(-number);
    outcome = worse(outcome, test_set(part.smallest, negated, part.after, ties));
  }
  return outcome;
}

int needed_levels(Quantifier quantifier, int levels) {
  switch (quantifier) {
    case Quantifier::Every:
      return levels;
    case Quantifier::Most:
      return (2 * levels + 2) / 3;
    case Quantifier::Half:
      return (levels + 1) / 2;
    default:
      return 1;
  }
}

RuleOutcome test_levels(Quantifier quantifier, std::vector<RuleOutcome> levels) {
  for (const RuleOutcome& level : levels)
    if (std::isnan(level.margin)) return {false, level.margin};
  const auto needed = static_cast<std::size_t>(needed_levels(quantifier, static_cast<int>(levels.size())));
  std::sort(levels.begin(), levels.end(), [](const RuleOutcome& a, const RuleOutcome& b) {
    return a.margin != b.margin ? a.margin > b.margin : a.holds && !b.holds;
  });
  return levels[needed - 1];
}

std::vector<int> ranks_of(const Numbers& numbers, const Scale& scale) {
  std::vector<int> ranks;
  for (const double own : numbers) {
    const double sign = scale.lower_is_better ? -1 : 1;
    ranks.push_back(1 + static_cast<int>(std::count_if(numbers.begin(), numbers.end(), [&](double other) {
                      return outcome_of(sign * (other - own) - scale.tau, false).holds;
                    })));
  }
  return ranks;
}

Numbers leads_of(const Numbers& numbers) {
  Numbers leads;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    leads.push_back(numbers[i] - largest_of(others_of(numbers, {static_cast<int>(i)})));
  return leads;
}

}  // namespace corral
