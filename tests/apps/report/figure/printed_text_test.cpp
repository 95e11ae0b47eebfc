// SPDX-License-Identifier: MIT
// Widths of text, and what is laid out by them.
#include "apps/report/figure/printed_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/report/figure/axis.h"
#include "apps/report/figure/drawing.h"
#include "apps/report/figure/legend.h"
#include "tests/apps/report/figure/report_folder.h"

namespace corral {
namespace {

using ::testing::ElementsAre;

TEST(PrintedText, IsAsWideAsGnuplotDrawsIt) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0 || !testing::has_pdftotext())
    GTEST_SKIP() << "gnuplot or pdftotext is not installed";
  const std::vector<std::string> texts = {"nnsr", "3.75", "[65,70)", "mmmmmmmm", "illi", "Größe"};  // no kerning
  Drawing drawing(kColumnWidth, 200);
  for (std::size_t i = 0; i < texts.size(); ++i)
    drawing.words(20, 20 + 20 * static_cast<double>(i), texts[i], Align::Left);
  const testing::ReportFolder folder;
  folder.svg_of("texts", "", figure_script("texts", drawing, {"unset border\nunset tics\nplot [0:1] [0:1] NaN\n"}));
  const testing::PrintedPage page = testing::read_page(folder / "figures/texts.pdf", folder / "page.html");
  ASSERT_EQ(page.words.size(), texts.size());
  EXPECT_NEAR(page.width, kColumnWidth, 1);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const testing::PrintedWord& word = page.words[i];
    EXPECT_EQ(word.text, texts[i]);
    EXPECT_NEAR(word.left, 20, 1) << texts[i];
    EXPECT_NEAR((word.top + word.bottom) / 2, 20 + 20 * static_cast<double>(i), 2) << texts[i];
    EXPECT_NEAR(word.right - word.left, printed_width(texts[i]), 0.02 * printed_width(texts[i])) << texts[i];
  }
}

TEST(PrintedText, IsShortenedAndWrappedToAWidth) {
  EXPECT_EQ(printed_width(""), 0);
  EXPECT_DOUBLE_EQ(printed_width("abab"), 2 * printed_width("ab"));
  EXPECT_DOUBLE_EQ(printed_width("ü"), printed_width("u"));  // one character of two bytes
  EXPECT_GT(printed_width("\xff\xc3"), 0);                   // no UTF-8
  EXPECT_EQ(widest_of({}), 0);
  EXPECT_EQ(widest_of({"m", "i"}), printed_width("m"));
  EXPECT_EQ(shortened("name", printed_width("name")), "name");
  EXPECT_EQ(shortened("nämename", printed_width("nä...") + 0.01), "nä...");
  EXPECT_EQ(shortened("nämename", printed_width("nä...") - 0.01), "n...");
  EXPECT_THAT(wrapped("one two  three", printed_width("one two")), ElementsAre("one two", "three"));
  EXPECT_THAT(wrapped("wide mmmmmmmmmm", printed_width("wide")).size(), 2U);
  EXPECT_LE(printed_width(wrapped("wide mmmmmmmmmm", printed_width("wide")).back()), printed_width("wide"));
  EXPECT_TRUE(wrapped("", 10).empty());
}

std::vector<double> evenly(std::size_t count, double pitch) {
  std::vector<double> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back(pitch * static_cast<double>(i));
  return places;
}

TEST(AxisLabels, StayLevelAreThinnedOrStandUpright) {
  const std::vector<std::string> numbers = {"1.25", "1.5", "1.75", "2.0", "2.25"};
  const double enough = printed_width("1.25") + kGap;
  EXPECT_EQ(fit_labels(numbers, evenly(5, enough)).texts, numbers);
  const AxisLabels thinned = fit_labels(numbers, evenly(5, enough - 0.01));
  EXPECT_THAT(thinned.texts, ElementsAre("1.25", "", "1.75", "", "2.25"));
  EXPECT_FALSE(thinned.are_upright);
  EXPECT_THAT(fit_labels(numbers, evenly(5, enough / 2 - 0.01)).texts, ElementsAre("", "1.5", "", "", "2.25"));
  const std::vector<std::string> words = {"a", "a rather long name", "b"};
  const double wide = printed_width(words[1]) + kGap;
  EXPECT_FALSE(fit_labels(words, evenly(3, wide)).are_upright);
  const AxisLabels upright = fit_labels(words, evenly(3, wide - 0.01));
  EXPECT_TRUE(upright.are_upright);
  EXPECT_EQ(upright.texts, words);
  EXPECT_GT(upright.depth, printed_width(words[1]));
  EXPECT_THAT(fit_labels(words, evenly(3, kLine - 0.01)).texts, ElementsAre("a", "", "b"));
  EXPECT_TRUE(fit_labels({}, {}).texts.empty());
  EXPECT_THAT(fit_labels({"alone"}, {0}).texts, ElementsAre("alone"));
}

TEST(Decades, EncloseEveryValueAboveZero) {
  Decades decades;
  EXPECT_THAT(decades.labels(), ElementsAre("1", "10"));
  for (const auto& value : {std::optional<double>(0.0), std::optional<double>(), std::optional<double>(0.02)})
    decades.add(value);
  EXPECT_THAT(decades.labels(), ElementsAre("0.01", "0.1"));
  decades.add(1);
  EXPECT_EQ(decades.low(), 0.01);
  EXPECT_EQ(decades.high(), 10);  // above the largest: a value at the border means that there is none
}

TEST(Legend, TakesAsFewRowsAsTheWidthAllows) {
  const std::vector<std::string> seven = {"ss", "nnsr", "ransac", "st", "gc", "hough", "si"};
  EXPECT_EQ(Legend(seven, kPageWidth).height(), kLine);
  EXPECT_LE(Legend(seven, kColumnWidth).height(), 3 * kLine);
  EXPECT_EQ(Legend(seven, 70).height(), 7 * kLine);
  EXPECT_EQ(Legend({}, kColumnWidth).height(), 0);
  const std::string longest(80, 'm');
  EXPECT_EQ(Legend({longest, longest + "m", "gc"}, kColumnWidth).height(), 2 * kLine);  // two columns at the least
}

}  // namespace
}  // namespace corral
