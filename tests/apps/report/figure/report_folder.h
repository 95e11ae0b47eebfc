// SPDX-License-Identifier: MIT
#pragma once

// The folder of a report in which a test draws figures, and the words that stand in them.

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "apps/report/figure/folders.h"
#include "apps/report/figure/gnuplot.h"
#include "tests/io/scratch.h"

namespace corral::testing {

struct ReportFolder : ScratchFolder {
  ReportFolder() {
    for (const char* part : {kFigures, kScripts, kData}) std::filesystem::create_directory(*this / part);
  }
  std::string svg_of(const std::string& name, const std::string& csv, const std::string& script) const {
    put_text(*this / (kData + name + ".csv"), csv);
    put_text(*this / (kScripts + name + ".gp"), script);
    run_gnuplot(path(), name);
    return text_of(*this / (kFigures + name + ".svg"));
  }
};

/// A word of a PDF and its box in points from the upper left corner.
struct PrintedWord {
  std::string text;
  double left, top, right, bottom;
};

struct PrintedPage {
  double width = 0, height = 0;
  std::vector<PrintedWord> words;
};

inline bool has_pdftotext() { return std::system("pdftotext -v >/dev/null 2>&1") == 0; }

/// As pdftotext (Debian: poppler-utils) reads it. `scratch` is a file that may be overwritten.
inline PrintedPage read_page(const std::string& pdf, const std::string& scratch) {
  PrintedPage page;
  if (std::system(("pdftotext -bbox '" + pdf + "' '" + scratch + "'").c_str()) != 0) return page;
  static const std::regex pattern(
      R"re(<(?:page width="([^"]*)" height="([^"]*)"|word xMin="([^"]*)" yMin="([^"]*)" xMax="([^"]*)" yMax="([^"]*)">(.*)</word))re");
  const std::string html = text_of(scratch);
  for (std::sregex_iterator found(html.begin(), html.end(), pattern), end; found != end; ++found) {
    const auto number = [&](std::size_t group) { return std::stod((*found)[group]); };
    if ((*found)[1].matched)
      page.width = number(1), page.height = number(2);
    else
      page.words.push_back({(*found)[7], number(3), number(4), number(5), number(6)});
  }
  for (PrintedWord& word : page.words)
    for (const auto& [from, to] : {std::pair<const char*, const char*>{"&lt;", "<"},
                                   {"&gt;", ">"},
                                   {"&quot;", "\""},
                                   {"&apos;", "'"},
                                   {"&amp;", "&"}})
      word.text = replaced(word.text, from, to);
  return page;
}

}  // namespace corral::testing
