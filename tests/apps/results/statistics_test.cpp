// SPDX-License-Identifier: MIT
// Frozen cases are of scipy 1.10.1; how each was made stands beside it.
#include "apps/results/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernel/error.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Values = std::vector<double>;

constexpr double kExact = 1e-10;

TEST(Wilcoxon, AgreesWithScipyWhereItIsExact) {
  // wilcoxon(d, method="exact")
  const WilcoxonTest few = wilcoxon_signed_rank({0.100369, 0.189624, 0.017759, -0.167178, -0.036401, -0.197494,
                                                 0.118043, 0.502065, -0.047662, -0.086142, 0.246953, 0.207066});
  EXPECT_TRUE(few.is_exact);
  EXPECT_EQ(few.statistic, 25);
  EXPECT_NEAR(few.p, 0.30126953125, kExact);
  const WilcoxonTest more = wilcoxon_signed_rank(
      {0.031624,  -0.27914,  -0.008776, 0.208591,  -0.403264, -0.137285, -0.570367, -0.386861, -0.552521,
       -0.070527, -0.380234, 0.081379,  0.047025,  -0.056079, -0.755028, -0.161608, -0.01455,  0.033993,
       -0.459041, -0.143326, -0.293556, -0.242651, 0.31827,   -0.24226,  -0.009757});
  EXPECT_EQ(more.statistic, 55);
  EXPECT_NEAR(more.p, 0.0027848482131958008, kExact);
}

TEST(Wilcoxon, AgreesWithScipyWhereItApproximates) {
  // wilcoxon(d, method="approx"): zeros left out, variance corrected for ties, no continuity correction
  const WilcoxonTest tied =
      wilcoxon_signed_rank({0.1, 0.2, 0.0, 0.3, -0.1, 0.2, 0.4, -0.3, 0.0, 0.5, 0.1, -0.2, 0.6, 0.7, 0.1});
  EXPECT_FALSE(tied.is_exact);
  EXPECT_EQ(tied.statistic, 17);
  EXPECT_NEAR(tied.p, 0.04540058063513438, kExact);
  Values many;  // [((i * 37) % 101 - 40) / 100 for i in range(60)]
  for (int i = 0; i < 60; ++i) many.push_back(((i * 37) % 101 - 40) / 100.0);
  const WilcoxonTest large = wilcoxon_signed_rank(many);
  EXPECT_FALSE(large.is_exact);
  EXPECT_EQ(large.statistic, 583);
  EXPECT_NEAR(large.p, 0.02263320893600752, kExact);
}

TEST(Wilcoxon, SeesNothingWhereNothingDiffers) {
  EXPECT_EQ(wilcoxon_signed_rank({}).p, 1);
  EXPECT_EQ(wilcoxon_signed_rank({0, 0, 0}).p, 1);
  EXPECT_EQ(wilcoxon_signed_rank({1, -2, -3, 4}).p, 1);    // 5 against 5
  EXPECT_EQ(wilcoxon_signed_rank({1, 2, 3, 4}).p, 0.125);  // all of one sign: 2 of 2^4
}

TEST(Holm, StepsDown) {
  EXPECT_THAT(holm_adjusted({0.01, 0.04, 0.03, 0.005}), ElementsAre(0.03, 0.06, 0.06, 0.02));
  EXPECT_THAT(holm_adjusted({0.5, 0.9}), ElementsAre(1.0, 1.0));
  EXPECT_THAT(holm_adjusted({}), IsEmpty());
}

TEST(McNemar, AgreesWithScipy) {
  struct Case {
    int first, second;
    double exact, chi_square, p;
  };
  // binomtest(b, b + c).pvalue; chi2.sf(max(0, |b - c| - 1)^2 / (b + c), 1)
  for (const Case& each :
       {Case{3, 11, 0.057373046875, 3.5, 0.0613688291394023}, Case{0, 5, 0.0625, 3.2, 0.07363827012030258},
        Case{40, 61, 0.04604406692934279, 3.9603960396039604, 0.04658274252301569}, Case{7, 7, 1, 0, 1},
        Case{1, 0, 1, 0, 1}, Case{0, 0, 1, 0, 1}}) {
    const McNemarTest test = mcnemar(each.first, each.second);
    EXPECT_NEAR(test.exact_p, each.exact, kExact) << each.first;
    EXPECT_NEAR(test.chi_square, each.chi_square, kExact) << each.first;
    EXPECT_NEAR(test.chi_square_p, each.p, kExact) << each.first;
    EXPECT_EQ(mcnemar(each.second, each.first).exact_p, test.exact_p);
  }
  EXPECT_THROW(mcnemar(-1, 3), InvalidInput);
}

TEST(StudentizedRange, AgreesWithScipyAndWithLongArithmetic) {
  // studentized_range.cdf(q, k, inf); mpmath with 30 digits gives the same
  EXPECT_NEAR(studentized_range_cdf(1.5, 2), 0.711155633653515132, 1e-14);
  EXPECT_NEAR(studentized_range_cdf(3.3, 3), 0.948689093581810124, 1e-14);
  EXPECT_NEAR(studentized_range_cdf(4.0, 7), 0.930041234370183854, 1e-14);
  EXPECT_NEAR(studentized_range_cdf(2.0, 10), 0.0767857613931468833, 1e-14);
  // studentized_range.ppf(0.95, k, inf), to the digits of mpmath
  const std::pair<int, double> quantiles[] = {{2, 2.77180764869935589},
                                              {3, 3.31449315539812098},
                                              {5, 3.85765551037862325},
                                              {7, 4.1695541550065473},
                                              {10, 4.47412422172590506}};
  for (const auto& [groups, quantile] : quantiles)
    EXPECT_NEAR(studentized_range_quantile(0.95, groups), quantile, 1e-12) << groups;
  EXPECT_NEAR(studentized_range_quantile(0.99, 7), 4.882166194995566, kExact);
  EXPECT_THROW(studentized_range_quantile(1, 7), InvalidInput);
  EXPECT_THROW(studentized_range_cdf(1, 1), InvalidInput);
}

TEST(Ranks, AgreeWithScipy) {
  // friedmanchisquare(*scores); rankdata(-scores, axis=0).mean(1)
  const RankComparison close = compare_ranks({{1.02, 1.16, 0.58, 0.69, 0.72, 0.71, 0.5, 0.94},
                                              {0.63, 0.26, 0.4, 0.69, 0.36, 0.41, 0.89, 0.2},
                                              {0.16, 0.78, 0.87, 0.73, 0.82, 0.9, 0.89, 0.47}});
  EXPECT_THAT(close.average_ranks, ElementsAre(1.8125, 2.625, 1.5625));
  EXPECT_NEAR(close.chi_square, 5.266666666666667, kExact);
  EXPECT_NEAR(close.p, 0.07183860068931328, kExact);
  // studentized_range.ppf(0.95, 3, inf) / sqrt(2) * sqrt(3 * 4 / (6 * 8)); Demsar's table has q = 2.343
  EXPECT_NEAR(close.critical_difference, 3.314493155398122 / std::sqrt(2.0) * 0.5, kExact);
  EXPECT_THAT(close.cliques, ElementsAre(ElementsAre(2, 0, 1)));
}

TEST(Ranks, FormCliquesFromTheBestOn) {
  // Four methods in the same order on 12 pairs, the last two tied: ranks 1, 2, 3.5, 3.5; the critical difference is 1.354.
  const RankComparison ranks = compare_ranks({Values(12, 4.0), Values(12, 3.0), Values(12, 1.0), Values(12, 1.0)});
  EXPECT_THAT(ranks.average_ranks, ElementsAre(1, 2, 3.5, 3.5));
  EXPECT_NEAR(ranks.critical_difference, 1.354, 1e-3);
  EXPECT_THAT(ranks.cliques, ElementsAre(ElementsAre(0, 1), ElementsAre(2, 3)));
  EXPECT_LT(ranks.p, 1e-6);
}

TEST(Ranks, RefuseWhatCannotBeRanked) {
  EXPECT_THROW(compare_ranks({{1, 2}}), InvalidInput);
  EXPECT_THROW(compare_ranks({{1, 2}, {1}}), InvalidInput);
  EXPECT_THROW(compare_ranks({{}, {}}), InvalidInput);
  EXPECT_THROW(compare_ranks({{1}, {std::numeric_limits<double>::quiet_NaN()}}), InvalidInput);
  EXPECT_EQ(compare_ranks({{1, 1}, {1, 1}}).p, 1);  // all tied
}

TEST(Spearman, AgreesWithScipy) {
  // spearmanr(a, b)
  EXPECT_NEAR(spearman({-2.11, 0.259, 0.044, -0.246, 0.039, -0.861, -1.513, -0.167, -0.972},
                       {-3.8, 0, 0, 0.2, -1.0, -1.5, -2.5, -1.1, -0.8}),
              0.6945667492672501, kExact);
  EXPECT_TRUE(std::isnan(spearman({1, 2, 3}, {5, 5, 5})));
}

TEST(Quantile, IsLinearBetweenValues) {
  EXPECT_EQ(quantile_of({4, 1, 2}, 0), 1);
  EXPECT_EQ(quantile_of({4, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile_of({4, 1, 2}, 0.75), 3);
  EXPECT_EQ(quantile_of({4, 1, 2}, 1), 4);
  EXPECT_EQ(quantile_of({7}, 0.25), 7);
}

TEST(WilsonInterval, IsThatOfTheTextbooks) {
  const auto [low, high] = wilson_interval(5, 10);
  EXPECT_NEAR(low, 0.2366, 1e-4);
  EXPECT_NEAR(high, 0.7634, 1e-4);
  EXPECT_EQ(wilson_interval(0, 10).first, 0);
  EXPECT_NEAR(wilson_interval(0, 10).second, 0.2775, 1e-4);
  EXPECT_EQ(wilson_interval(10, 10).second, 1);
  EXPECT_EQ(wilson_interval(0, 0), std::make_pair(0.0, 1.0));
}

}  // namespace
}  // namespace corral
