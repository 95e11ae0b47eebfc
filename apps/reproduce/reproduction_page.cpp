// SPDX-License-Identifier: MIT
#include "apps/reproduce/reproduction_page.h"

#include "apps/reproduce/reproduction_files.h"
#include "apps/runtime/text_table.h"

namespace corral {
namespace {

constexpr char kHead[] = R"html(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<title>Corral: what the findings depend on</title>
<style>
body { font: 14px/1.4 sans-serif; margin: 2em; color: #222; background: #fff }
table { border-collapse: collapse; margin: 1em 0 }
th, td { border: 1px solid #ccc; padding: 2px 6px; text-align: left; vertical-align: top }
.matrix thead th { writing-mode: vertical-rl; transform: rotate(180deg); white-space: nowrap; border-color: #eee }
.matrix thead th:first-child, .matrix thead th:last-child { writing-mode: horizontal-tb; transform: none }
.matrix td { text-align: center } .matrix td:last-child { text-align: left }
.holds { background: #9fd3a8 } .fails { background: #f0b9a8 } .undecidable { background: #eee; color: #777 }
.turned { outline: 2px solid #333; outline-offset: -2px }
pre { background: #f6f6f6; padding: 1em; overflow-x: auto }
</style></head><body>
<h1>What the findings depend on</h1>
)html";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text)
    if (letter == '&')
      safe += "&amp;";
    else if (letter == '<')
      safe += "&lt;";
    else if (letter == '>')
      safe += "&gt;";
    else if (letter == '"')
      safe += "&quot;";
    else
      safe += letter;
  return safe;
}

std::string tag(const std::string& name, const std::string& text) {
  return "<" + name + ">" + text + "</" + name + ">";
}

std::string points_table(const Reproduction& of) {
  std::string rows = tag("tr", tag("th", "open point") + tag("th", "reading") + tag("th", "what it says") +
                                   tag("th", "from") + tag("th", "evidence"));
  for (const OpenPoint& point : of.points) {
    bool is_first = true;
    for (const Reading& reading : point.readings) {
      std::string row;
      if (is_first)
        row = "<td rowspan=\"" + std::to_string(point.readings.size()) + "\"><b>" + escaped(point.name) + "</b><br>" +
              escaped(point.question) + "</td>";
      is_first = false;
      for (const std::string& cell : {reading.name, reading.text, reading.from, reading.evidence})
        row += tag("td", escaped(cell));
      rows += tag("tr", row) + "\n";
    }
  }
  return tag("table", rows);
}

/// A mark that needs no colour; the margin is told on hovering.
std::string cell_of(const ClaimOutcome& outcome, Verdict by_text) {
  const char* const mark = outcome.verdict == Verdict::Holds   ? "+"
                           : outcome.verdict == Verdict::Fails ? "&minus;"
                                                               : "&middot;";
  const bool is_turned = (outcome.verdict == Verdict::Holds) != (by_text == Verdict::Holds);
  return "<td class=\"" + verdict_name(outcome.verdict) + (is_turned ? " turned" : "") + "\" title=\"" +
         fixed(outcome.margin, 3) + "\">" + mark + "</td>";
}

std::string matrix_table(const Reproduction& of) {
  std::string head = tag("th", "");
  for (const CombinationScore& score : of.alone) head += tag("th", escaped(to_text(of.points, score.combination)));
  head += tag("th", "found") + tag("th", "text, held out") + tag("th", "found, held out") + tag("th", "statement");
  std::string rows;
  for (std::size_t claim = 0; claim < of.claims.size(); ++claim) {
    const Verdict by_text = of.alone.front().outcomes[claim].verdict;
    std::string row = tag("th", escaped(of.claims[claim].id));
    for (const CombinationScore& score : of.alone) row += cell_of(score.outcomes[claim], by_text);
    row += cell_of(of.found.all.outcomes[claim], by_text);
    for (const CombinationScore* score : {&of.text.held_out, &of.found.held_out})
      row += cell_of(score->outcomes[claim], of.text.held_out.outcomes[claim].verdict);
    rows +=
        tag("tr", row + tag("td", escaped(of.claims[claim].text + " (" + class_name(of.classes[claim]) + ")"))) + "\n";
  }
  return "<table class=\"matrix\">" + tag("thead", tag("tr", head)) + tag("tbody", rows) + "</table>";
}

}  // namespace

std::string reproduction_html(const Reproduction& of) {
  return std::string(kHead) +
         "<p>+ holds, &minus; fails, &middot; undecidable; framed: other than under the text's "
         "reading. A column is one reading alone, all other points read as in the text.</p>\n" +
         matrix_table(of) + "\n" + tag("pre", escaped(reproduction_text(of))) + "\n" + points_table(of) +
         "\n</body></html>\n";
}

}  // namespace corral
