// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/pair/evaluate_pair.h"
#include "apps/runtime/json.h"

namespace corral {

Json to_json(const GroupingScore& score);

/// Appends the errors of a pose, each key after the prefix, null where undefined:
/// rotation_error_deg, translation_error_pr, rmse_pr, mean_error_pr, add_share, add_s_share, success_5pr (is_registered),
/// success_from_pr (the least of success_thresholds_pr() at which it is), success_add and success_add_s (below a tenth).
/// `is_judged`: an absent pose counts as a failure; otherwise its success is unknown.
void add_errors(Json& json, const std::string& prefix, const std::optional<PoseErrors>& errors, bool is_judged);

/// The refinement: pose, costs, covariance, and with a truth the errors of the pose and, after "initial_", of its start.
Json pose_json(const MethodRecord& record);

/// A row of the table of groupers, with the errors of the refined pose and, after "initial_", of the fit to the selection;
/// the result of the dense refinement is in a member of its own.
Json to_json(const MethodRecord& record);

/// The table of a pair for people, one row per grouper, then oracle and baseline; without empty columns.
std::string methods_text(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds = {});
/// The rows for scripts: the keys of to_json are the columns, exact numbers, 1 and 0, empty where undefined.
std::string methods_csv(const std::vector<MethodRecord>& records);

/// The same of the refinement over all matches: `change` is "gained" or "lost" where it decides whether the pair is registered.
std::string all_rows_text(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds = {});

/// The same of the dense refinement.
std::string dense_text(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds = {});
std::string dense_csv(const std::vector<MethodRecord>& records);

}  // namespace corral
