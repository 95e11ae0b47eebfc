// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stdexcept>

namespace corral {

/// Exit statuses of the program.
enum ExitStatus { kOk = 0, kOtherFailure = 1, kUsage = 2, kBadInput = 3, kPartial = 4 };

/// The command line is wrong.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The work of the chosen subcommand; set while the command line is parsed, called afterwards. Returns the exit status.
using Action = std::function<int()>;

// Each adds one subcommand that sets `action`.
void add_info(CLI::App& app, Action& action);
void add_match(CLI::App& app, Action& action);
void add_import(CLI::App& app, Action& action);
void add_group(CLI::App& app, Action& action);
void add_refine(CLI::App& app, Action& action);
void add_score(CLI::App& app, Action& action);
void add_register(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_conformance(CLI::App& app, Action& action);
void add_tables(CLI::App& app, Action& action);  ///< groupers, detectors, descriptors
void add_perturb(CLI::App& app, Action& action);
void add_transform(CLI::App& app, Action& action);
void add_triangulate(CLI::App& app, Action& action);
void add_evaluate(CLI::App& app, Action& action);
void add_advise(CLI::App& app, Action& action);
void add_calibrate(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_submit(CLI::App& app, Action& action);
void add_scoreboard(CLI::App& app, Action& action);
void add_scan(CLI::App& app, Action& action);
void add_dataset(CLI::App& app, Action& action);
void add_dataset_make(CLI::App& dataset, Action& action);
void add_dataset_import(CLI::App& dataset, Action& action);
void add_claims(CLI::App& app, Action& action);
void add_reproduce(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_draw(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_align(CLI::App& app, Action& action);
void add_manual(CLI::App& app, Action& action);

}  // namespace corral
