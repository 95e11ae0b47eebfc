// SPDX-License-Identifier: MIT
#include "apps/pair/foreign_answer.h"

#include <cmath>
#include <filesystem>
#include <new>

#include "io/matches/label_file.h"
#include "io/pose/transform_file.h"
#include "io/text/csv_file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// FILE, FILE:KEY and FILE:NAME alike.
void need(const std::string& name) {
  std::error_code ignored;
  if (!std::filesystem::exists(split_transform_name(name).file, ignored))
    throw IoError(name, "", "does not exist: no answer to this pair");
}

/// Absent where the table has no row of the pair, or an empty cell.
std::optional<double> stated_time(const ForeignAnswer& answer, const std::string& pair) {
  if (answer.times.empty()) return answer.time_ms;
  const CsvTable table = read_csv(answer.times);
  const int names = table.column("pair"), times = table.column("ms");
  if (names < 0 || times < 0) throw IoError(answer.times, "header", "expected the columns pair and ms");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (table.rows[row][static_cast<std::size_t>(names)] != pair) continue;
    const std::string& cell = table.rows[row][static_cast<std::size_t>(times)];
    if (cell.empty()) return std::nullopt;
    const std::optional<double> time = parse_double(cell);
    if (!time || !std::isfinite(*time) || *time < 0)
      throw IoError(answer.times, "row " + std::to_string(row + 1),
                    "ms is " + corral::quoted(cell) + ", expected a time of at least zero, or nothing");
    return time;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> ForeignAnswer::files() const {
  std::vector<std::string> given;
  for (const std::string& file : {labels, pose, times})
    if (!file.empty()) given.push_back(file);
  return given;
}

GroupingResult read_answer(const ForeignAnswer& answer, const CorrespondenceSet& matches) {
  GroupingResult found;
  if (!answer.labels.empty()) {
    need(answer.labels);
    found.selected = read_selection(answer.labels, matches.size());
  }
  if (answer.pose.empty()) return found;
  need(answer.pose);
  found.target_from_source = read_transform(answer.pose);
  if (!answer.labels.empty()) return found;
  const std::vector<bool> within = label_correct(matches, *found.target_from_source, kStatedPosePr);
  for (std::size_t row = 0; row < within.size(); ++row)
    if (within[row]) found.selected.push_back(static_cast<int>(row));
  return found;
}

MethodRecord evaluate_answer(const std::string& method, const ForeignAnswer& answer, const std::string& pair,
                             const CorrespondenceSet& matches, const std::optional<PairTruth>& truth) {
  MethodRecord record;
  record.method = method;
  try {
    record.found = read_answer(answer, matches);
    record.stated_time_ms = stated_time(answer, pair);
    judge(record, matches, truth, true);
  } catch (const std::bad_alloc&) {
    throw;  // not a failure of the method
  } catch (const std::exception& error) {
    record.failure = *error.what() ? error.what() : "no reason given";
  }
  return record;
}

}  // namespace corral
