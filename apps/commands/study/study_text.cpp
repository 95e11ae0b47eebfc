// SPDX-License-Identifier: MIT
#include "apps/commands/study/study_text.h"

#include <algorithm>
#include <map>

#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"

namespace corral {
namespace {

constexpr std::size_t kMostWarnings = 5;

/// As warnings; the study has them all.
void say_some(const std::string& kind, const std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < std::min(lines.size(), kMostWarnings); ++i) say("warning: " + kind + lines[i]);
  if (lines.size() > kMostWarnings)
    say("warning: " + std::to_string(lines.size() - kMostWarnings) + " more of this kind; --json lists all");
}

/// What is shown of a grouper in an experiment: the mean of its levels.
struct Overview {
  int levels = 0, pairs = 0, excluded = 0, misfit = 0, empty = 0, failed = 0;
  std::vector<double> sums;  ///< of the headline measures
};

}  // namespace

std::string overview_text(const std::vector<SummaryRow>& rows) {
  const std::vector<const Measure*> headline = measures_with(kHeadline);
  std::vector<std::pair<std::string, std::string>> order;
  std::map<std::pair<std::string, std::string>, Overview> cells;
  for (const SummaryRow& row : rows) {
    const auto key = std::make_pair(row.experiment, row.method);
    if (!cells.count(key)) order.push_back(key);
    Overview& cell = cells[key];
    cell.pairs += row.pairs, cell.excluded += row.excluded, cell.misfit += row.misfit;
    cell.empty += row.empty, cell.failed += row.failed;
    cell.sums.resize(headline.size());
    if (row.pairs == 0) continue;
    ++cell.levels;
    for (std::size_t i = 0; i < headline.size(); ++i) cell.sums[i] += *row.of(headline[i]->name).value;
  }
  std::vector<std::string> header = {"experiment", "method", "pairs", "excluded", "misfit", "empty", "failed"};
  for (const Measure* measure : headline) header.push_back(measure->title);
  TextTable table(header);
  for (const auto& key : order) {
    const Overview& cell = cells.at(key);
    std::vector<std::string> line = {key.first,
                                     key.second,
                                     std::to_string(cell.pairs),
                                     std::to_string(cell.excluded),
                                     std::to_string(cell.misfit),
                                     std::to_string(cell.empty),
                                     std::to_string(cell.failed)};
    for (std::size_t i = 0; i < headline.size(); ++i)
      line.push_back(cell.levels > 0 ? fixed(cell.sums[i] / cell.levels, headline[i]->decimals) : "");
    table.add(line);
  }
  return table.str() +
         "Means over the levels of an experiment, at each level over its pairs; an empty selection has precision and\n"
         "recall 0, pairs without correct matches are excluded, and so are those whose truth\n"
         "does not fit the surfaces (misfit). success: share of pairs whose refined mean error is at\n"
         "most 5 pr. summary.csv has every level.\n";
}

std::string explanation_text(const std::vector<LossRow>& rows) {
  std::vector<std::string> header = {"experiment", "grouper", "pairs"};
  for (std::size_t stage = 0; stage < kStages; ++stage) header.push_back(to_text(static_cast<Stage>(stage)));
  TextTable table(header);
  for (const LossRow& row : over_levels(rows)) {
    std::vector<std::string> line = {row.experiment, row.method, std::to_string(row.pairs)};
    for (std::size_t stage = 0; stage < kStages; ++stage)
      line.push_back(row.pairs > 0 ? fixed(row.share(static_cast<Stage>(stage)), 3) : "");
    table.add(line);
  }
  return table.str() +
         "Shares of all pairs with a truth, over all levels: registered by the refined pose (mean error of at most 5\n"
         "pr), or lost: with fewer than 20 matched keypoints in the overlap; with too few correct matches, so that\n"
         "not even all of them register the pair; by the selection of the grouper; by the refinement of its pose;\n"
         "because the truth does not fit; because matching or grouper failed. --json has every level.\n";
}

Json explanation_json(const std::vector<LossRow>& rows) {
  Json json = Json::array();
  for (const LossRow& row : rows) {
    Json& object = json.emplace_back(Json{{"experiment", row.experiment},
                                          {"dataset", row.dataset},
                                          {"level", row.level},
                                          {"method", row.method},
                                          {"pairs", row.pairs}});
    for (std::size_t stage = 0; stage < kStages; ++stage)
      object[to_text(static_cast<Stage>(stage))] =
          row.pairs > 0 ? Json(row.share(static_cast<Stage>(stage))) : Json(nullptr);
  }
  return json;
}

Json study_json(const std::string& folder, const StudyOutcome& outcome) {
  return {{"run", folder},
          {"pairs", outcome.units},
          {"failed", outcome.failed},
          {"misfits", outcome.misfits},
          {"warnings", outcome.warnings}};
}

std::string counts_text(const StudyOutcome& outcome) {
  return std::to_string(outcome.units) + " pairs, " + std::to_string(outcome.failed) + " failed" +
         (outcome.failed > 0 ? " (records.csv says why)" : "");
}

std::string duration(double seconds) {
  if (seconds < 120) return fixed(seconds, 0) + " s";
  return seconds < 7200 ? fixed(seconds / 60, 0) + " min" : fixed(seconds / 3600, 1) + " h";
}

std::string progress_text(const StudyProgress& now, bool is_first) {
  constexpr double kLong = 10;
  const std::string text = std::to_string(now.done) + " of " + std::to_string(now.total) + " pairs done, " +
                           std::to_string(now.failed) + " failed";
  if (!is_first || now.expected_s < kLong) return text;
  return text + ", expected to take about " + duration(now.expected_s) + " on one processor";
}

void say_study(const StudyOutcome& outcome) {
  say_some("truth does not fit: ", outcome.misfits);
  say_some("", outcome.warnings);
}

}  // namespace corral
