// SPDX-License-Identifier: MIT
#include "apps/pair/conformance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "apps/pair/evaluate_pair.h"
#include "apps/runtime/text_table.h"
#include "kernel/random.h"
#include "kernel/synthetic.h"

namespace corral {
namespace {

SyntheticProblem problem(int matches, double share, std::uint64_t seed) {
  SyntheticOptions options;
  options.matches = matches;
  options.inlier_ratio = share;
  options.noise_pr = 0.3;
  options.seed = seed;
  return make_synthetic_problem(options);
}

/// What is wrong with the form of an answer; empty if nothing is.
std::string form_problem(const GroupingResult& found, int matches) {
  for (std::size_t i = 0; i < found.selected.size(); ++i) {
    const int row = found.selected[i];
    if (row < 0 || row >= matches) return "selects row " + std::to_string(row) + " of " + std::to_string(matches);
    if (i > 0 && row <= found.selected[i - 1]) return "its rows are not ascending, each once";
  }
  if (!found.scores.empty() && found.scores.size() != static_cast<std::size_t>(matches))
    return "has " + std::to_string(found.scores.size()) + " scores for " + std::to_string(matches) + " matches";
  if (!std::all_of(found.scores.begin(), found.scores.end(), [](double score) { return std::isfinite(score); }))
    return "has scores that are not finite";
  return "";
}

/// How many rows only one of the two has.
std::size_t difference(const Indices& one, const Indices& other) {
  Indices rows;
  std::set_symmetric_difference(one.begin(), one.end(), other.begin(), other.end(), std::back_inserter(rows));
  return rows.size();
}

class Contract {
 public:
  explicit Contract(const GroupFunction& group) : group_(group) {}

  std::vector<ConformanceCheck> check() {
    check_on("empty table", CorrespondenceSet(), [](const GroupingResult& found, const CorrespondenceSet&) {
      return found.selected.empty() ? "" : std::string("selects a match of a table without any");
    });
    for (const int rows : {1, 2, 3})
      check_on(std::to_string(rows) + (rows == 1 ? " match" : " matches"), problem(rows, 1, 1).matches, accept);
    check_on("rows and scores", problem(300, 0.2, 2).matches, accept);
    check_not_finite();
    const std::vector<CorrespondenceSet> tables = {problem(300, 0.3, 3).matches, problem(400, 0.03, 4).matches};
    check_same("same answer twice", tables, 0, [](const CorrespondenceSet& table, Indices&) { return table; });
    check_same("order of the rows", tables, 0, [](const CorrespondenceSet& table, Indices& old_row) {
      RandomStream random(5);
      for (std::size_t i = old_row.size(); i > 1; --i) std::swap(old_row[i - 1], old_row[random.below(i)]);
      return select_rows(table, old_row);
    });
    check_same("unit of length", tables, 0, [](CorrespondenceSet table, Indices&) {
      for (Points* points : {&table.source_points, &table.target_points}) *points *= kFactor;
      if (table.source_centroid) *table.source_centroid *= kFactor;
      table.resolution *= kFactor;
      return table;
    });
    check_same("motion of the target", tables, 0.02, [](CorrespondenceSet table, Indices&) {
      RigidTransform motion;
      motion.rotation = RandomStream(6).rotation();
      motion.translation = {100, -50, 30};
      table.target_points = motion.apply(table.target_points);
      for (auto& frame : table.target_frames) frame = frame * motion.rotation.transpose();
      return table;
    });
    check_easy();
    measure_time();
    return std::move(checks_);
  }

 private:
  static constexpr double kFactor = 1024;
  using Judge = std::function<std::string(const GroupingResult&, const CorrespondenceSet&)>;

  static std::string accept(const GroupingResult&, const CorrespondenceSet&) { return ""; }

  /// Calls the grouper and has the answer judged: in its form, then by `judge`, which says what is wrong.
  void check_on(const std::string& name, const CorrespondenceSet& table, const Judge& judge) {
    std::string wrong;
    try {
      const GroupingResult found = group_(table);
      wrong = form_problem(found, table.size());
      if (wrong.empty()) wrong = judge(found, table);
    } catch (const std::exception& error) {
      wrong = error.what();
    }
    add(name, wrong, table);
  }

  void add(const std::string& name, const std::string& wrong, const CorrespondenceSet& table) {
    checks_.push_back({name, wrong.empty(), wrong, {}});
    if (!wrong.empty()) checks_.back().table = table;
  }

  void check_not_finite() {
    CorrespondenceSet table = problem(100, 0.5, 7).matches;
    constexpr int kRow = 50;
    table.target_points(kRow, 1) = std::numeric_limits<double>::quiet_NaN();
    std::string wrong;
    try {
      const GroupingResult found = group_(table);
      wrong = form_problem(found, table.size());
      if (wrong.empty() && std::binary_search(found.selected.begin(), found.selected.end(), kRow))
        wrong = "selects a match that is not finite (row 50), neither refusing the table nor leaving it out";
    } catch (const std::exception&) {  // refused
    }
    add("a match that is not finite", wrong, table);
  }

  /// The answer on a changed table, whose row i was row old_row[i], must be that on the table, but for a share of the rows.
  void check_same(const std::string& name, const std::vector<CorrespondenceSet>& tables, double share,
                  const std::function<CorrespondenceSet(const CorrespondenceSet&, Indices& old_row)>& change) {
    for (const CorrespondenceSet& table : tables) {
      std::string wrong;
      try {
        Indices old_row(static_cast<std::size_t>(table.size()));
        std::iota(old_row.begin(), old_row.end(), 0);
        const CorrespondenceSet changed = change(table, old_row);
        const Indices before = group_(table).selected;
        Indices after = group_(changed).selected;
        for (int& row : after) row = old_row.at(static_cast<std::size_t>(row));
        std::sort(after.begin(), after.end());
        const std::size_t differ = difference(before, after);
        if (static_cast<double>(differ) > share * table.size())
          wrong = std::to_string(differ) + " of " + std::to_string(table.size()) +
                  " matches are selected in one of the two answers only";
      } catch (const std::exception& error) {
        wrong = error.what();
      }
      if (!wrong.empty()) return add(name, wrong, table);
    }
    checks_.push_back({name, true, "", {}});
  }

  void check_easy() {
    const SyntheticProblem easy = problem(200, 0.5, 8);
    check_on("easy table", easy.matches, [&](const GroupingResult& found, const CorrespondenceSet& table) {
      MethodRecord record;
      record.found = found;
      judge(record, table, table_truth(table, easy.truth, 4));
      if (!is_registered(record.errors)) return std::string("its refined pose does not register it");
      if (!(record.score->precision.value_or(0) > 0.5))
        return "its precision is " + fixed(record.score->precision.value_or(0), 3) + ", no more than without it (0.5)";
      return std::string();
    });
  }

  void measure_time() {
    std::string text;
    double x = 0, y = 0, xx = 0, xy = 0;
    const std::vector<int> sizes = {250, 500, 1000, 2000};
    try {
      for (const int size : sizes) {
        const double ms = time_grouping(group_, problem(size, 0.2, 9).matches, 3).time_ms;
        text += (text.empty() ? "" : ", ") + fixed(ms, 2);
        const double u = std::log(size), v = std::log(std::max(ms, 1e-3));
        x += u, y += v, xx += u * u, xy += u * v;
      }
      const auto n = static_cast<double>(sizes.size());
      text += " ms on 250, 500, 1000, 2000 matches: exponent " + fixed((n * xy - x * y) / (n * xx - x * x), 1);
    } catch (const std::exception& error) {
      text = error.what();
    }
    checks_.push_back({"time", std::nullopt, text, {}});
  }

  const GroupFunction& group_;
  std::vector<ConformanceCheck> checks_;
};

}  // namespace

std::vector<ConformanceCheck> check_conformance(const GroupFunction& group) { return Contract(group).check(); }

}  // namespace corral
