// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <stdexcept>

#include "apps/pair/match_pair.h"
#include "apps/pair/read_surface.h"
#include "grouping/registry.h"
#include "kernel/surface/scan/view_triangulation.h"

namespace corral {

/// Exit statuses of the program.
enum ExitStatus { kOk = 0, kOtherFailure = 1, kUsage = 2, kBadInput = 3, kPartial = 4 };

/// The command line asks for what does not exist.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What the chosen subcommand will do; set while the command line is parsed, run afterwards. Returns the exit status.
using Action = std::function<int()>;

// Each adds one subcommand that sets `action`.
void add_info(CLI::App& app, Action& action);
void add_match(CLI::App& app, Action& action);
void add_group(CLI::App& app, Action& action);
void add_refine(CLI::App& app, Action& action);
void add_score(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_groupers(CLI::App& app, Action& action);
void add_perturb(CLI::App& app, Action& action);
void add_triangulate(CLI::App& app, Action& action);
void add_evaluate(CLI::App& app, Action& action);
void add_scan(CLI::App& app, Action& action);
void add_dataset(CLI::App& app, Action& action);
void add_dataset_make(CLI::App& dataset, Action& action);
void add_dataset_import(CLI::App& dataset, Action& action);
void add_claims(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_draw(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_align(CLI::App& app, Action& action);

// Options that several subcommands have.
void add_match_options(CLI::App& command, MatchSettings& settings);
void check_usage(const MatchSettings& settings);  ///< throws UsageError
void check_threshold(double threshold_pr);        ///< throws UsageError

/// The text of an option as a point or direction "x,y,z". Throws UsageError.
Eigen::Vector3d parse_vector(const std::string& option, const std::string& text);

/// --threads, checked where workers() are made of it.
void add_threads(CLI::App& command, int& threads);

/// --sensor and --direction, as typed.
struct SensorSettings {
  std::string sensor = "0,0,0";
  std::optional<std::string> direction;
};
void add_sensor_options(CLI::App& command, SensorSettings& settings);
ViewOptions view_options(const SensorSettings& settings);  ///< throws UsageError

/// --memory-limit, in bytes; half of the machine unless it is given.
void add_memory_limit(CLI::App& command, std::uint64_t& bytes);

/// The names of all methods with something between them.
std::string method_list(const std::string& separator);

/// The named method with "key=value" texts applied. Throws UsageError.
ConfiguredGrouper configure_grouper(const std::string& method, const std::vector<std::string>& settings);

}  // namespace corral
