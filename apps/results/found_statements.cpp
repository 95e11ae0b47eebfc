// SPDX-License-Identifier: MIT
#include "apps/results/found_statements.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/results/bootstrap.h"
#include "apps/runtime/text_table.h"

namespace corral {
namespace {

constexpr std::size_t kFewestPairs = 5;
constexpr std::uint64_t kSeed = 1;

/// Two columns of shares on the rows where both have a number.
struct Compared {
  std::vector<double> first, second;

  Compared(const RowNumbers& a, const RowNumbers& b, const std::vector<std::size_t>& rows) {
    for (const std::size_t row : rows)
      if (!std::isnan(a[row]) && !std::isnan(b[row])) first.push_back(a[row]), second.push_back(b[row]);
  }
  std::optional<FoundStatement> statement(const SetTable& table) const {
    if (first.size() < kFewestPairs) return std::nullopt;
    std::vector<double> differences;
    for (std::size_t i = 0; i < first.size(); ++i) differences.push_back(first[i] - second[i]);
    const MeanInterval found = bootstrap_mean(differences, kSeed);
    if (found.mean == 0) return std::nullopt;
    return FoundStatement{"", table.dataset, static_cast<int>(first.size()), found.mean, found.low, found.high};
  }
  std::string shares() const { return fixed(mean_of(first), 2) + " against " + fixed(mean_of(second), 2); }
};

class SetStatements {
 public:
  explicit SetStatements(const SetTable& table) : table_(table), choice_(choose_method(table)) {
    for (std::size_t row = 0; row < table.pairs.size(); ++row) all_.push_back(row);
  }

  std::optional<FoundStatement> refinement() const {
    std::string method;
    double most = 0;
    for (const MethodShare& each : choice_.methods) {
      const double before = mean_of(table_.column(each.method, "initial_success_5pr"));
      if (each.method == "gc") {
        method = each.method;
        break;
      }
      if (each.success - before > most) most = each.success - before, method = each.method;
    }
    if (method.empty()) return std::nullopt;
    return compared(column(method), table_.column(method, "initial_success_5pr"),
                    "Refinement raises the share of pairs that " + method + " registers");
  }

  std::optional<FoundStatement> perfect() const {
    if (!choice_.perfect || choice_.methods.empty()) return std::nullopt;
    return compared(column("oracle"), column(best()),
                    "All correct matches register more pairs than the best grouper, " + best());
  }

  std::optional<FoundStatement> against_best(const std::string& measure, const std::string& words) const {
    std::string other;
    double most = -1;
    for (const MethodShare& each : choice_.methods) {
      const double mean = mean_of(table_.column(each.method, measure));
      if (mean > most) most = mean, other = each.method;
    }
    if (other.empty() || other == best()) return std::nullopt;
    return compared(column(best()), column(other),
                    best() + " registers more pairs than " + other + ", " + words + " (" + fixed(most, 2) + ")");
  }

  std::optional<FoundStatement> hardest() const {
    for (std::size_t bin = 0; bin < kCorrectShares.size(); ++bin) {
      std::vector<std::size_t> rows;
      for (const std::size_t row : all_)
        if (!std::isnan(table_.correct_share[row]) && correct_share_bin(table_.correct_share[row]) == bin)
          rows.push_back(row);
      if (rows.size() < kFewestPairs) continue;
      std::vector<std::pair<double, std::string>> shares;  // of groupers with any pose there
      for (const MethodShare& each : choice_.methods) {
        RowNumbers within;
        for (const std::size_t row : rows) within.push_back(column(each.method)[row]);
        const double mean = mean_of(within);
        if (!std::isnan(mean)) shares.emplace_back(mean, each.method);
      }
      std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
      if (shares.size() < 2 || shares.front().first < 0.5) continue;
      const std::string &first = shares[0].second, &second = shares[1].second;
      const Compared both(column(first), column(second), rows);
      return told(both, "From " + correct_share_text(bin) +
                            " of correct matches on a grouper registers half of the pairs; there " + first +
                            " registers most, before " + second);
    }
    return std::nullopt;
  }

 private:
  const std::string& best() const { return choice_.methods.front().method; }
  const RowNumbers& column(const std::string& method) const { return table_.column(method, "success_5pr"); }

  std::optional<FoundStatement> told(const Compared& both, const std::string& text) const {
    auto statement = both.statement(table_);
    if (statement) statement->text = text + ": " + both.shares();
    return statement;
  }
  std::optional<FoundStatement> compared(const RowNumbers& first, const RowNumbers& second,
                                         const std::string& text) const {
    return told(Compared(first, second, all_), text);
  }

  const SetTable& table_;
  MethodChoice choice_;
  std::vector<std::size_t> all_;
};

}  // namespace

std::vector<FoundStatement> found_statements(const std::vector<SetTable>& tables, std::size_t most) {
  std::vector<SetStatements> sets;
  for (const SetTable& table : tables) sets.emplace_back(table);
  std::vector<FoundStatement> found;
  const auto add = [&](const std::optional<FoundStatement>& statement) {
    if (statement && found.size() < most) found.push_back(*statement);
  };
  for (const SetStatements& set : sets) add(set.refinement());
  for (const SetStatements& set : sets) add(set.perfect());
  for (const SetStatements& set : sets) add(set.hardest());
  for (const SetStatements& set : sets) add(set.against_best("precision", "the most precise"));
  for (const SetStatements& set : sets) add(set.against_best("recall", "that with the best recall"));
  return found;
}

}  // namespace corral
