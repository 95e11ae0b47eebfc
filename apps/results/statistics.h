// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

namespace corral {

/// Whether paired differences are centred at zero, two-sided. Zeros are left out (Wilcoxon's treatment). Exact for at most
/// 50 differences without zeros and ties (scipy's method "exact"), else the normal approximation with the variance
/// corrected for ties and without a continuity correction (scipy's method "approx"). p is 1 if nothing differs.
struct WilcoxonTest {
  double statistic = 0;  ///< the lesser of the two sums of ranks
  double p = 1;
  bool is_exact = false;
};
WilcoxonTest wilcoxon_signed_rank(const std::vector<double>& differences);

/// Holm's step-down adjustment of p-values that were tested together.
std::vector<double> holm_adjusted(const std::vector<double>& p);

/// Whether two groupers succeed equally often on the same pairs, from the pairs on which only one of them does.
struct McNemarTest {
  double exact_p = 1;                       ///< binomial, two-sided
  double chi_square = 0, chi_square_p = 1;  ///< with Edwards' continuity correction, one degree of freedom
};
McNemarTest mcnemar(int only_first, int only_second);

/// Wilson's interval of 95 % for a share of successes; (0, 1) without trials. Successes may be expected ones.
std::pair<double, double> wilson_interval(double successes, int trials);

/// The range of `groups` independent standard normal variables: the studentized range with infinitely many degrees of
/// freedom. Quantile to about 1e-13. Throw InvalidInput for fewer than 2 groups, or p outside (0, 1).
double studentized_range_cdf(double range, int groups);
double studentized_range_quantile(double p, int groups);

/// Methods ranked on each of the same pairs (1 is best, ties share), as a critical-difference diagram shows them
/// [demsar2006statistical].
struct RankComparison {
  std::vector<double> average_ranks;      ///< in the order given
  double chi_square = 0, p = 1;           ///< Friedman's test that all are equal, corrected for ties
  double critical_difference = 0;         ///< Nemenyi's, at 5 %: average ranks further apart than this differ
  std::vector<std::vector<int>> cliques;  ///< maximal groups within it, of 2 or more, each sorted from the best
};
/// scores[method][pair], higher is better. Throws InvalidInput for fewer than 2 methods, no pair, ragged rows, or values
/// that are no numbers.
RankComparison compare_ranks(const std::vector<std::vector<double>>& scores);

/// Between the order statistics, so that 0 gives the least value and 1 the largest; NaN without values.
double quantile_of(std::vector<double> values, double p);

/// Ranks from 1 in ascending order; equal values share the mean of theirs.
std::vector<double> shared_ranks(const std::vector<double>& values);

/// Spearman's rank correlation; NaN if there are fewer than 2 values or one side is constant.
double spearman(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace corral
