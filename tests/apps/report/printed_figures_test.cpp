// SPDX-License-Identifier: MIT
// Every figure of a report on paper: where its words are, with the fonts of a bare machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "apps/results/study_folder.h"
#include "tests/apps/report/figure/report_folder.h"
#include "tests/support/program.h"
#include "tests/support/simulated_run.h"

namespace corral::testing {
namespace {

using ::testing::HasSubstr;

/// A study that is hard to draw: thirteen groupers, some with long names, and many, long and odd levels.
StudyFolder crowded_study(const std::string& folder) {
  const std::vector<std::string> groupers = {"ss",
                                             "nnsr",
                                             "ransac",
                                             "st",
                                             "gc",
                                             "hough",
                                             "si",
                                             "graph_cut",
                                             "ransac2",
                                             "my 'own' 50 %",
                                             "spectral-relaxation-with-weights",
                                             "WWWWWWWW",
                                             "x"};
  StudyFolder run;
  run.folder = folder;
  const auto add = [&](const std::string& name, const std::vector<std::string>& labels, const std::string& title) {
    ExperimentInfo& info = run.experiments.emplace_back();
    info.name = info.attribute = name;
    info.dataset = "b3r";
    info.figure = "a";
    info.title = title;
    info.axis = "deviation of the noise (pr)";
    info.methods = groupers;
    for (std::size_t level = 0; level < labels.size(); ++level) {
      const auto value = static_cast<double>(level);
      info.levels.push_back({labels[level], value, value});
      for (std::string method : groupers)
        for (int pair = 0; pair < 3; ++pair) {
          const double score =
              static_cast<double>((7 * level + 5 * method.size() + static_cast<std::size_t>(pair)) % 11) / 10;
          StudyRecord& record = run.records.emplace_back();
          record.experiment = name;
          record.dataset = "b3r";
          record.level = labels[level];
          record.pair = "pair" + std::to_string(pair);
          record.method = method;
          record.status = {MethodState::Refined};
          record.value = value;
          record.matches = 1000;
          record.true_matches = 100;
          record.selected = 100;
          record.precision = record.recall = record.f1 = score;
          for (PoseScores* pose : {&record.initial, &record.refined, &record.dense})
            if (score > 0.2) pose->mean_error_pr = 100 * score * score * score;
          record.time_ms = 0.001 + 30 * score;
        }
    }
  };
  add("steps", {"0.75", "1", "1.25", "1.5", "1.75", "2", "2.25", "2.5", "2.75", "3", "3.25", "3.5", "3.75"}, "Steps");
  add("words", {"raw", "after simplification to a tenth", "with normals of the faces, 50 %", "[65,70)"},
      "A title of an experiment that is too long for a column and names <b>odd</b> & \"quoted\" things");
  add("bins", {"[60,65)", "[65,70)", "[70,75)", "[75,80)", "[80,85)", "[85,90]"}, "Bins");
  add("table_size", {"250", "500", "1000", "1500", "2000", "3000", "100000"}, "Times");
  return run;
}

/// gnuplot and corral see the font of this file only.
void use_only(const std::string& font, const std::string& folder) {
  std::filesystem::create_directories(folder + "/fonts");
  std::filesystem::copy(font, folder + "/fonts");
  put_text(folder + "/fonts.conf",
           "<?xml version=\"1.0\"?><!DOCTYPE fontconfig SYSTEM \"fonts.dtd\"><fontconfig><dir>" + folder +
               "/fonts</dir><cachedir>" + folder + "/cache</cachedir></fontconfig>");
  ::setenv("FONTCONFIG_FILE", (folder + "/fonts.conf").c_str(), 1);
}

/// The words that the script of a figure writes.
std::set<std::string> written_words(const std::string& script) {
  std::set<std::string> words = {"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"};  // gnuplot's own
  static const std::regex quoted("'([^']*)'");
  const std::string quote = "\x01", plain = replaced(replaced(script, "''", quote), "%%", "%");
  for (std::sregex_iterator found(plain.begin(), plain.end(), quoted), end; found != end; ++found) {
    std::istringstream text(replaced((*found)[1], quote, "'"));
    for (std::string word; text >> word;) words.insert(word);
  }
  return words;
}

bool overlap(const PrintedWord& a, const PrintedWord& b) {
  constexpr double kTouch = 0.2;  // points
  return std::min(a.right, b.right) - std::max(a.left, b.left) > kTouch &&
         std::min(a.bottom, b.bottom) - std::max(a.top, b.top) > kTouch;
}

void expect_printable(const PrintedPage& page, const std::set<std::string>& written) {
  EXPECT_GT(page.words.size(), 8U);
  EXPECT_TRUE(std::abs(page.width - 8.5 * 72 / 2.54) < 1 || std::abs(page.width - 17 * 72 / 2.54) < 1) << page.width;
  for (auto word = page.words.begin(); word != page.words.end(); ++word) {
    // Words that lie on each other are read as one that nobody wrote.
    EXPECT_EQ(written.count(word->text), 1U) << word->text;
    EXPECT_GE(word->left, 0) << word->text;
    EXPECT_GE(word->top, 0) << word->text;
    EXPECT_LE(word->right, page.width) << word->text;
    EXPECT_LE(word->bottom, page.height) << word->text;
    const double height = std::min(word->bottom - word->top, word->right - word->left);
    EXPECT_LT(height, 8 * 1.3) << word->text;  // text in 8 pt
    for (auto other = page.words.begin(); other != word; ++other)
      EXPECT_FALSE(overlap(*word, *other)) << word->text << " and " << other->text;
  }
}

class PrintedFigures : public ::testing::TestWithParam<const char*> {
 protected:
  ~PrintedFigures() override { ::unsetenv("FONTCONFIG_FILE"); }
};

TEST_P(PrintedFigures, NoWordOverlapsAnotherOrLeavesThePage) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0 || !has_pdftotext())
    GTEST_SKIP() << "gnuplot or pdftotext is not installed";
  const Workplace place;
  const std::string font = "/usr/share/fonts/truetype/" + std::string(GetParam());
  if (!std::filesystem::exists(font)) GTEST_SKIP() << font << " is not installed";
  use_only(font, place / "machine");
  write_run(crowded_study(place / "run"));
  const Outcome outcome = place.corral("report run -o out --pairs-in-3d 0");
  ASSERT_THAT(outcome.err, HasSubstr("the report is"));
  int figures = 0;
  for (const auto& file : std::filesystem::directory_iterator(place / "out/figures")) {
    if (file.path().extension() != ".pdf") continue;
    ++figures;
    const std::string name = file.path().stem();
    SCOPED_TRACE(name);
    expect_printable(read_page(file.path(), place / "page.html"),
                     written_words(place.text("out/scripts/" + name + ".gp")));
  }
  EXPECT_EQ(figures, 3 * 9 + 3);
}

// Debian's fontconfig brings DejaVu, which is wide; corral's scripts bring Liberation.
INSTANTIATE_TEST_SUITE_P(Fonts, PrintedFigures,
                         ::testing::Values("dejavu/DejaVuSans.ttf", "liberation/LiberationSans-Regular.ttf"));

}  // namespace
}  // namespace corral::testing
