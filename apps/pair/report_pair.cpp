// SPDX-License-Identifier: MIT
#include "apps/pair/report_pair.h"

#include <algorithm>

#include "apps/runtime/text_table.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

const std::vector<TableColumn> kMethodColumns = {{"grouper", "method"},
                                                 {"selected", "selected", 0},
                                                 {"precision", "precision", 3},
                                                 {"recall", "recall", 3},
                                                 {"F1", "f1", 3},
                                                 {"time ms", "time_ms", 2},
                                                 {"fit err pr", "initial_mean_error_pr", 3},
                                                 {"rot err deg", "rotation_error_deg", 3},
                                                 {"transl err pr", "translation_error_pr", 3},
                                                 {"mean err pr", "mean_error_pr", 3},
                                                 {"RMSE pr", "rmse_pr", 3},
                                                 {"ADD", "add_share", 4},
                                                 {"confidence", "confidence", 3},
                                                 {"outcome", "outcome"},
                                                 {"status", "status"}};

const std::vector<TableColumn> kAllRowsColumns = {{"grouper", "method"},
                                                  {"rot err deg", "rotation_error_deg", 3},
                                                  {"transl err pr", "translation_error_pr", 3},
                                                  {"mean err pr", "mean_error_pr", 3},
                                                  {"RMSE pr", "rmse_pr", 3},
                                                  {"ADD", "add_share", 4},
                                                  {"change", "change"},
                                                  {"status", "status"}};

const std::vector<TableColumn> kDenseColumns = {{"grouper", "method"},
                                                {"overlap before", "overlap_before", 3},
                                                {"overlap", "overlap", 3},
                                                {"residual before pr", "residual_before_pr", 3},
                                                {"residual pr", "residual_pr", 3},
                                                {"rot err deg", "rotation_error_deg", 4},
                                                {"transl err pr", "translation_error_pr", 4},
                                                {"mean err pr", "mean_error_pr", 4},
                                                {"RMSE pr", "rmse_pr", 4},
                                                {"ADD", "add_share", 4},
                                                {"status", "status"}};

/// The row of a method, without the dense refinement.
Json method_row(const MethodRecord& record) {
  const bool has_answer = record.failure.empty();
  std::optional<double> precision, recall, f1;
  if (record.score && has_answer)
    precision = record.score->precision, recall = record.score->recall, f1 = record.score->f1;
  const bool is_judged = record.score && has_answer;
  Json row = {{"method", record.method},
              {"selected", has_answer ? Json(record.found.selected.size()) : Json(nullptr)},
              {"precision", json_or_null(precision)},
              {"recall", json_or_null(recall)},
              {"f1", json_or_null(f1)},
              {"time_ms", has_answer ? json_or_null(record.time_ms) : Json(nullptr)}};
  add_errors(row, "", record.errors, is_judged);
  add_errors(row, "initial_", record.initial_errors, is_judged);
  row["confidence"] = json_or_null(record.confidence);
  row["outcome"] = is_judged ? Json(record.outcome()) : Json(nullptr);
  row["status"] = to_text(record.status());
  return row;
}

/// The result of the dense refinement; all null but the status if there was no pose to start from.
Json dense_row(const MethodRecord& record) {
  const RefinedSurface dense = record.dense.value_or(RefinedSurface());
  const auto number = [&](double value) { return record.dense ? Json(value) : Json(nullptr); };
  Json row = {{"overlap_before", number(dense.before.overlap)},
              {"overlap", number(dense.after.overlap)},
              {"residual_before_pr", number(dense.before.rms_pr)},
              {"residual_pr", number(dense.after.rms_pr)}};
  add_errors(row, "", record.dense_errors, record.dense && record.score);
  row["condition"] = number(dense.condition);
  row["status"] = record.dense ? to_text(record.dense->status) : "no pose to start from";
  return row;
}

/// The result of the refinement over all matches.
Json all_rows_row(const MethodRecord& record) {
  Json row = {{"method", record.method}};
  add_errors(row, "", record.all_rows_errors, record.all_rows && record.score);
  const bool before = is_registered(record.errors), after = is_registered(record.all_rows_errors);
  row["change"] = record.score && record.all_rows ? Json(before == after ? "none"
                                                         : after         ? "gained"
                                                                         : "lost")
                                                  : Json(nullptr);
  row["status"] = record.all_rows ? to_text(record.all_rows->status) : "no pose to start from";
  return row;
}

/// The row of dense.csv.
Json named_dense_row(const MethodRecord& record) {
  Json row = {{"method", record.method}};
  row.update(dense_row(record));
  return row;
}

/// Characters that would end a field are replaced.
std::string csv_cell(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_number_float()) return to_text(value.get<double>());
  if (value.is_number()) return value.dump();
  std::string text = value.get<std::string>();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == '"' || c == '\n'; }, ';');
  return text;
}

template <class Row>
std::string csv_of(const std::vector<MethodRecord>& records, const Row& row_of) {
  std::string text;
  const Json names = row_of(MethodRecord());
  for (const auto& [key, value] : names.items()) text += (text.empty() ? "" : ",") + key;
  text += "\n";
  for (const MethodRecord& record : records) {
    std::string line;
    const Json row = row_of(record);
    for (const auto& [key, value] : row.items()) line += (key == "method" ? "" : ",") + csv_cell(value);
    text += line + "\n";
  }
  return text;
}

/// A table of these rows without empty columns.
std::string full_columns_text(const std::vector<Json>& rows, std::vector<TableColumn> columns) {
  const auto is_empty = [&](const TableColumn& column) {
    return std::all_of(rows.begin(), rows.end(), [&](const Json& row) { return row[column.key].is_null(); });
  };
  columns.erase(std::remove_if(columns.begin(), columns.end(), is_empty), columns.end());
  return table_text(rows, columns);
}

template <class Row>
std::vector<Json> rows_of(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds,
                          const Row& row_of) {
  std::vector<Json> rows;
  for (const auto* part : {&records, &bounds})
    for (const MethodRecord& record : *part) rows.push_back(row_of(record));
  return rows;
}

}  // namespace

Json to_json(const GroupingScore& score) {
  return {{"matches", score.matches},
          {"selected", score.selected},
          {"correct", score.correct},
          {"true_matches", score.true_matches},
          {"precision", json_or_null(score.precision)},
          {"recall", json_or_null(score.recall)},
          {"f1", json_or_null(score.f1)}};
}

void add_errors(Json& json, const std::string& prefix, const std::optional<PoseErrors>& errors, bool is_judged) {
  std::optional<double> rotation, translation, rmse, mean, add, add_s, success_from;
  std::optional<bool> success, success_add, success_add_s;
  if (errors) {
    rotation = errors->rotation_error_deg;
    translation = errors->translation_error_pr;
    if (errors->points) rmse = errors->points->rmse_pr, mean = errors->points->mean_pr;
    add = errors->add_share;
    add_s = errors->add_s_share;
  }
  if (is_judged || mean) success = is_registered(errors);
  if (add || (is_judged && !errors)) success_add = add && *add < kSuccessAddShare;
  if (add_s || (is_judged && !errors)) success_add_s = add_s && *add_s < kSuccessAddShare;
  const std::vector<double>& thresholds = success_thresholds_pr();
  const auto least = std::find_if(thresholds.begin(), thresholds.end(), [&](double t) { return mean && *mean <= t; });
  if (least != thresholds.end()) success_from = *least;
  json[prefix + "rotation_error_deg"] = json_or_null(rotation);
  json[prefix + "translation_error_pr"] = json_or_null(translation);
  json[prefix + "rmse_pr"] = json_or_null(rmse);
  json[prefix + "mean_error_pr"] = json_or_null(mean);
  json[prefix + "add_share"] = json_or_null(add);
  json[prefix + "add_s_share"] = json_or_null(add_s);
  json[prefix + "success_5pr"] = json_or_null(success);
  json[prefix + "success_from_pr"] = json_or_null(success_from);
  json[prefix + "success_add"] = json_or_null(success_add);
  json[prefix + "success_add_s"] = json_or_null(success_add_s);
}

Json pose_json(const MethodRecord& record) {
  const RefinedPose& pose = record.pose;
  Json json = {{"status", to_text(pose.status)},
               {"target_from_source", pose.target_from_source ? to_json(*pose.target_from_source) : Json(nullptr)}};
  add_errors(json, "", record.errors, record.score.has_value());
  json["iterations"] = pose.iterations;
  json["converged"] = pose.converged;
  json["initial"] = pose.initial ? to_json(*pose.initial) : Json(nullptr);
  add_errors(json, "initial_", record.initial_errors, record.score.has_value());
  json["initial_rms_pr"] = pose.initial ? Json(pose.initial_rms_pr) : Json(nullptr);
  json["final_rms_pr"] = pose.target_from_source ? Json(pose.final_rms_pr) : Json(nullptr);
  json["initial_cost"] = pose.initial ? Json(pose.initial_cost) : Json(nullptr);
  json["final_cost"] = pose.target_from_source ? Json(pose.final_cost) : Json(nullptr);
  json["condition"] = json_or_null(pose.condition);
  json["covariance"] = nullptr;
  if (pose.covariance) {
    json["covariance"] = Json::array();
    for (int row = 0; row < 6; ++row) {
      Json numbers = Json::array();
      for (int column = 0; column < 6; ++column) numbers.push_back((*pose.covariance)(row, column));
      json["covariance"].push_back(numbers);
    }
  }
  return json;
}

Json to_json(const MethodRecord& record) {
  Json json = method_row(record);
  if (record.all_rows) {
    json["all_rows"] = all_rows_row(record);
    json["all_rows"].erase("method");
    json["all_rows"]["pose"] =
        record.all_rows->target_from_source ? to_json(*record.all_rows->target_from_source) : Json(nullptr);
  }
  if (!record.dense) return json;
  json["dense"] = dense_row(record);
  json["dense"]["pose"] = record.dense->target_from_source ? to_json(*record.dense->target_from_source) : Json(nullptr);
  return json;
}

std::string methods_text(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds) {
  return full_columns_text(rows_of(records, bounds, method_row), kMethodColumns);
}

std::string methods_csv(const std::vector<MethodRecord>& records) { return csv_of(records, method_row); }

std::string all_rows_text(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds) {
  return full_columns_text(rows_of(records, bounds, all_rows_row), kAllRowsColumns);
}

std::string dense_text(const std::vector<MethodRecord>& records, const std::vector<MethodRecord>& bounds) {
  return full_columns_text(rows_of(records, bounds, named_dense_row), kDenseColumns);
}

std::string dense_csv(const std::vector<MethodRecord>& records) { return csv_of(records, named_dense_row); }

}  // namespace corral
