// SPDX-License-Identifier: MIT
#include "apps/study/plan.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <queue>
#include <unordered_map>

#include "apps/pair/methods.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr std::uint64_t kMostRows = 1'000'000;
constexpr std::uint64_t kMost = std::uint64_t{1} << 50;  // microseconds, bytes: their sums stay in range

/// How many keypoints a surface with so many vertices has: at most one in each disk of the detector's length.
std::uint64_t keypoints_of(const WorkUnit& unit, std::uint64_t vertices) {
  const double length = parse_double(keypoint_length(unit.matching).value).value_or(1);
  const auto thousandths = static_cast<std::uint64_t>(std::llround(1000 * std::min(std::max(length, 0.1), 1000.0)));
  return std::min({vertices, vertices * 166'667 / (thousandths * thousandths), kMostRows});
}

std::uint64_t size_of(const std::string& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  return error ? 0 : std::min<std::uintmax_t>(size, std::uint64_t{1} << 40);
}

/// Keeps what it has looked up: many units share files, and groupers with their options.
class Estimator {
 public:
  UnitEstimate operator()(const WorkUnit& unit) {
    const std::uint64_t source = bytes_of(unit.pair.source) / 40, target = bytes_of(unit.pair.target) / 40;
    const std::uint64_t vertices = source + target, calls = unit.tasks.size();
    const bool is_table = !unit.pair.matches.empty();
    const std::uint64_t rows =
        is_table ? std::min(bytes_of(unit.pair.matches) / 100, kMostRows) : keypoints_of(unit, source);
    const std::uint64_t described = is_table ? 0 : keypoints_of(unit, target);
    std::uint64_t nanoseconds = 6'000'000 + 1'800 * vertices + 24 * rows * described;
    for (const GroupingTask& task : unit.tasks) nanoseconds += call_nanoseconds(task.method, rows);
    if (unit.confidence) nanoseconds += call_nanoseconds("register", rows);
    if (unit.dense) nanoseconds += calls * 6'000 * vertices;
    std::uint64_t memory = 0;
    for (const GroupingTask& task : unit.tasks) memory = std::max(memory, memory_of(task, static_cast<int>(rows)));
    const std::uint64_t bytes = 40'000'000 + 400 * vertices + 3'200 * (rows + described) + memory;
    return {std::min(nanoseconds / 1000, kMost), std::min(bytes, kMost)};
  }

 private:
  std::uint64_t bytes_of(const std::string& file) {
    if (file.empty()) return 0;
    const auto [place, is_new] = sizes_.try_emplace(file, 0);
    if (is_new) place->second = size_of(file);
    return place->second;
  }

  std::uint64_t memory_of(const GroupingTask& task, int rows) {
    if (task.answer || task.external) return 0;  // of another program nothing is known
    std::pair<std::string, OptionOverrides> key{task.method, task.options};
    key.second.erase("seed");  // every call has its own
    const auto [place, is_new] = memory_.try_emplace(std::move(key));
    if (is_new) place->second = find_method(task.method).configure(task.options).working_memory;
    return place->second ? static_cast<std::uint64_t>(std::min(place->second(rows), static_cast<double>(kMost))) : 0;
  }

  std::unordered_map<std::string, std::uint64_t> sizes_;
  std::map<std::pair<std::string, OptionOverrides>, std::function<double(int)>> memory_;
};

}  // namespace

std::uint64_t call_nanoseconds(const std::string& method, std::uint64_t matches) {
  if (method == "register") return 1'000'000 * matches;
  if (method == "auto") return 15'000 * matches;
  const std::uint64_t tenths = method == "gtm" ? 330 : method == "st" ? 40 : method == "si" ? 13 : 1;
  return 1'100 * matches + tenths * matches * matches / 10;
}

std::vector<UnitEstimate> estimate_units(const WorkList& list) {
  Estimator estimate;
  std::vector<UnitEstimate> estimates;
  estimates.reserve(list.units.size());
  for (const WorkUnit& unit : list.units) estimates.push_back(estimate(unit));
  return estimates;
}

std::vector<int> split_units(const std::vector<UnitEstimate>& estimates, int shards) {
  std::vector<std::size_t> order(estimates.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return estimates[a].microseconds > estimates[b].microseconds; });
  using Load = std::pair<std::uint64_t, int>;  // work so far, shard
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (int shard = 1; shard <= shards; ++shard) loads.push({0, shard});
  std::vector<int> shard_of(estimates.size());
  for (const std::size_t unit : order) {
    auto [load, shard] = loads.top();
    loads.pop();
    shard_of[unit] = shard;
    loads.push({load + estimates[unit].microseconds, shard});
  }
  return shard_of;
}

std::vector<ShardPlan> plan_shards(const std::vector<UnitEstimate>& estimates, int shards,
                                   const std::vector<double>& seconds) {
  const std::vector<int> shard_of = split_units(estimates, shards);
  std::vector<ShardPlan> plans(static_cast<std::size_t>(shards));
  for (std::size_t unit = 0; unit < estimates.size(); ++unit) {
    ShardPlan& plan = plans[static_cast<std::size_t>(shard_of[unit] - 1)];
    ++plan.pairs;
    plan.seconds += seconds.empty() ? estimates[unit].seconds() : seconds[unit];
    plan.peak_bytes = std::max(plan.peak_bytes, static_cast<double>(estimates[unit].bytes));
  }
  return plans;
}

}  // namespace corral
