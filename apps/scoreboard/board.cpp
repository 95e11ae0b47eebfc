// SPDX-License-Identifier: MIT
#include "apps/scoreboard/board.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "apps/results/statistics.h"
#include "kernel/error.h"

namespace corral {

namespace {

/// The judged rows of an experiment, over all levels.
struct Judged {
  std::vector<std::string> pairs;
  RowNumbers shares;  ///< of correct matches
};

Judged judged_of(const ExperimentTable& table) {
  Judged judged;
  for (const LevelTable& level : table.levels) {
    const auto share = level.of_pairs.find("inlier_ratio");
    for (std::size_t row = 0; row < level.pairs.size(); ++row) {
      if (level.roles[row] != PairRole::Judged) continue;
      judged.pairs.push_back(level.level.label + " " + level.pairs[row]);
      judged.shares.push_back(share == level.of_pairs.end() ? std::nan("") : share->second[row]);
    }
  }
  return judged;
}

/// The numbers of a method on the judged rows; NaN where it has none.
RowNumbers numbers_of(const ExperimentTable& table, const std::string& method, const std::string& measure) {
  RowNumbers numbers;
  for (const LevelTable& level : table.levels) {
    const auto columns = level.methods.find(method);
    for (std::size_t row = 0; row < level.pairs.size(); ++row) {
      if (level.roles[row] != PairRole::Judged) continue;
      double number = std::nan("");
      if (columns != level.methods.end()) {
        const auto found = columns->second.numbers.find(measure);
        if (found != columns->second.numbers.end()) number = found->second[row];
      }
      numbers.push_back(number);
    }
  }
  return numbers;
}

std::optional<double> mean_if_any(const RowNumbers& numbers) {
  const double mean = mean_of(numbers);
  return std::isnan(mean) ? std::nullopt : std::optional<double>(mean);
}

std::optional<double> median_time(const std::vector<StudyRecord>& records, const ExperimentInfo& info,
                                  const std::string& method, OptionalNumber StudyRecord::*time) {
  std::vector<double> times;
  for (const StudyRecord& record : records)
    if (record.method == method && record.experiment == info.name && record.dataset == info.dataset && record.*time)
      times.push_back(*(record.*time));
  if (times.empty()) return std::nullopt;
  return quantile_of(times, 0.5);
}

BoardRow row_of(const StudyResults& study, const ExperimentTable& table, const Judged& judged,
                const std::string& method) {
  BoardRow row;
  row.method = method;
  row.is_submitted = table.info.titles.count(method) > 0;
  const RowNumbers success = numbers_of(table, method, "success_5pr");
  row.all = success_share(success);
  std::vector<RowNumbers> by_share(kCorrectShares.size());
  for (std::size_t i = 0; i < success.size(); ++i)
    if (!std::isnan(judged.shares[i])) by_share[correct_share_bin(judged.shares[i])].push_back(success[i]);
  for (const RowNumbers& within : by_share) {
    const SuccessShare share = success_share(within);
    row.by_share.push_back(share.pairs > 0 ? std::optional<SuccessShare>(share) : std::nullopt);
  }
  row.precision = mean_if_any(numbers_of(table, method, "precision"));
  row.recall = mean_if_any(numbers_of(table, method, "recall"));
  row.f1 = mean_if_any(numbers_of(table, method, "f1"));
  row.confidence = mean_if_any(numbers_of(table, method, "confidence"));
  row.median_ms = median_time(study.run->records, table.info, method, &StudyRecord::time_ms);
  if (!row.median_ms) {
    row.median_ms = median_time(study.run->records, table.info, method, &StudyRecord::stated_time_ms);
    row.is_time_stated = row.median_ms.has_value();
  }
  return row;
}

void rank(Board& board) {
  std::stable_sort(board.rows.begin(), board.rows.end(), [](const BoardRow& a, const BoardRow& b) {
    const auto place = [](const BoardRow& row) { return row.method == "oracle" ? 0 : row.all.pairs > 0 ? 1 : 2; };
    if (place(a) != place(b)) return place(a) < place(b);
    return a.all.success != b.all.success ? a.all.success > b.all.success : a.method < b.method;
  });
  int place = 0;
  const BoardRow* before = nullptr;
  for (BoardRow& row : board.rows) {
    if (row.method == "oracle" || row.all.pairs == 0) continue;
    ++place;
    row.rank = before && before->all.success == row.all.success ? before->rank : place;
    before = &row;
  }
}

}  // namespace

const BoardRow* Board::row_of(const std::string& method) const {
  for (const BoardRow& row : rows)
    if (row.method == method) return &row;
  return nullptr;
}

std::vector<Board> make_boards(const std::vector<StudyResults>& studies) {
  std::vector<Board> boards;
  std::vector<Judged> pairs;
  for (const StudyResults& study : studies)
    for (const ExperimentTable& table : study.tables) {
      if (is_of_times(table.info)) continue;
      const Judged judged = judged_of(table);
      const auto is_it = [&](const Board& board) {
        return board.experiment == table.info.name && board.dataset == table.info.dataset;
      };
      auto board = std::find_if(boards.begin(), boards.end(), is_it);
      if (board == boards.end()) {
        boards.push_back(
            {table.info.name, table.info.dataset, table.info.title, static_cast<int>(judged.pairs.size()), {}});
        pairs.push_back(judged);
        board = boards.end() - 1;
      } else if (pairs[static_cast<std::size_t>(board - boards.begin())].pairs != judged.pairs) {
        throw IoError(study.run->folder, table.info.name,
                      "judges other pairs of " + table.info.dataset + " than another study, expected the same");
      }
      std::vector<std::string> methods = table.info.methods;
      if (!board->row_of("oracle")) methods.push_back("oracle");
      for (const std::string& method : methods) {
        if (board->row_of(method))
          throw IoError(study.run->folder, table.info.name,
                        "has the method " + method + ", which another study has too");
        board->rows.push_back(row_of(study, table, judged, method));
      }
    }
  for (Board& board : boards) rank(board);
  return boards;
}

}  // namespace corral
