// SPDX-License-Identifier: MIT
// Small tables for every grouper and for the refinement, and what the contract promises of the answer.
#include <Eigen/LU>
#include <cmath>

#include "grouping/registry.h"
#include "refine/refine_rigid.h"
#include "tests/fuzz/target.h"
#include "tests/support/execution.h"
#include "tests/support/table_changes.h"

namespace corral::fuzz {
namespace {

constexpr int kMostRows = 40;

/// A frame among the 24 that are exact, or turned a little, or none.
LocalReferenceFrame frame_of(Bytes& bytes) {
  const int kind = bytes.below(32);
  if (kind == 31) return LocalReferenceFrame::Zero();
  LocalReferenceFrame frame = LocalReferenceFrame::Identity();
  for (int turn = kind; turn > 0; turn /= 2) {
    LocalReferenceFrame quarter;
    quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    if (turn % 2 == 1) quarter << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    frame = quarter * frame;
  }
  return frame;
}

template <double (Bytes::*number)()>
CorrespondenceSet table_of(Bytes& bytes) {
  CorrespondenceSet table;
  const int columns = bytes.below(8), rows = bytes.below(kMostRows + 1);
  const double sizes[] = {1, 0.25, 1024, 0.1};
  table.resolution = sizes[bytes.below(4)];
  table.source_points.resize(rows, 3);
  table.target_points.resize(rows, 3);
  const bool is_motion = bytes.below(2) == 1;  // then most rows agree
  for (int row = 0; row < rows; ++row) {
    const bool agrees = is_motion && bytes.below(4) != 0;
    for (int axis = 0; axis < 3; ++axis) {
      table.source_points(row, axis) = (bytes.*number)();
      table.target_points(row, (axis + 1) % 3) = agrees ? table.source_points(row, axis) + axis : (bytes.*number)();
    }
  }
  if (columns & 1) {
    table.feature_distance.resize(rows);
    table.second_feature_distance.resize(rows);
    for (int row = 0; row < rows; ++row) {
      table.second_feature_distance(row) = std::abs((bytes.*number)());
      table.feature_distance(row) = table.second_feature_distance(row) * bytes.below(21) / 20;
    }
  }
  if (columns & 2)
    for (int row = 0; row < rows; ++row) {
      table.source_frames.push_back(frame_of(bytes));
      table.target_frames.push_back(frame_of(bytes));
    }
  if (columns & 4)
    for (int row = 0; row < rows; ++row) {
      table.source_keypoints.push_back(bytes.below(50));
      table.target_keypoints.push_back(bytes.below(50));
    }
  return table;
}

void check_answer(const GroupingResult& found, const CorrespondenceSet& table) {
  for (std::size_t i = 0; i < found.selected.size(); ++i)
    require(found.selected[i] >= 0 && found.selected[i] < table.size() &&
                (i == 0 || found.selected[i] > found.selected[i - 1]),
            "rows ascend and are in the table");
  require(found.scores.empty() || found.scores.size() == static_cast<std::size_t>(table.size()),
          "a score for each match");
  for (const double score : found.scores) require(!std::isnan(score), "a score is a number");
  if (!found.target_from_source) return;
  const Eigen::Matrix3d& turn = found.target_from_source->rotation;
  require(turn.allFinite() && found.target_from_source->translation.allFinite(), "a pose is finite");
  require((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm() < 1e-6 && turn.determinant() > 0,
          "a pose is rigid");
}

/// Fewer draws than by default, so that there are more tables.
OptionOverrides quick(const Grouper& grouper) {
  OptionOverrides options;
  for (const OptionValue& option : grouper.options) {
    if (option.name == "iterations" || option.name == "max_trials") options[option.name] = "60";
    if (option.name == "max_steps") options[option.name] = "2000";
  }
  return options;
}

void group_with(const std::string& name, const std::string& input) {
  Bytes bytes(input);
  const bool is_wild = bytes.below(4) == 0;
  const CorrespondenceSet table = is_wild ? table_of<&Bytes::coordinate>(bytes) : table_of<&Bytes::moderate>(bytes);
  const GroupFunction group = find_grouper(name).configure(quick(find_grouper(name))).group;
  const GroupingResult found = group(table);
  require(table.source_points.allFinite() && table.target_points.allFinite(), "a table that is not finite is refused");
  check_answer(found, table);
  const auto is_same = [&](const GroupingResult& other) {
    return other.selected == found.selected && other.scores == found.scores;
  };
  require(is_same(group(table)), "the same table has the same answer");
  for (const std::int64_t target : testing::available_targets()) {
    const testing::ForcedTarget forced(target);
    require(is_same(group(table)), "the same answer on every vector target");
  }
  if (!is_wild)
    require(group(testing::scaled(table, 1024)).selected == found.selected, "the unit of length does not matter");
}

void refine(const std::string& input) {
  Bytes bytes(input);
  RefineOptions options;
  options.loss = static_cast<RobustLoss>(bytes.below(5));
  const bool is_wild = bytes.below(4) == 0;
  const CorrespondenceSet table = is_wild ? table_of<&Bytes::coordinate>(bytes) : table_of<&Bytes::moderate>(bytes);
  Indices rows;
  for (int row = 0; row < table.size(); ++row)
    if (row % 7 != 5) rows.push_back(row);
  const RefinedPose found = refine_rigid(table, rows, options);
  require(found.target_from_source.has_value() == (found.status == RefineStatus::Refined),
          "a pose unless it says why not");
  if (!found.target_from_source) return;
  require(found.final_cost <= found.initial_cost, "the cost does not grow");
  const Eigen::Matrix3d& turn = found.target_from_source->rotation;
  require(turn.allFinite() && found.target_from_source->translation.allFinite(), "a pose is finite");
  require((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm() < 1e-6, "a pose is rigid");
}

}  // namespace

const std::vector<Target>& grouper_targets() {
  static const std::vector<Target> all = {
      {"ss", [](const std::string& bytes) { group_with("ss", bytes); }},
      {"nnsr", [](const std::string& bytes) { group_with("nnsr", bytes); }},
      {"ransac", [](const std::string& bytes) { group_with("ransac", bytes); }},
      {"st", [](const std::string& bytes) { group_with("st", bytes); }},
      {"gc", [](const std::string& bytes) { group_with("gc", bytes); }},
      {"hough", [](const std::string& bytes) { group_with("hough", bytes); }},
      {"si", [](const std::string& bytes) { group_with("si", bytes); }},
      {"turboreg", [](const std::string& bytes) { group_with("turboreg", bytes); }},
      {"sc2pcr", [](const std::string& bytes) { group_with("sc2pcr", bytes); }},
      {"clique", [](const std::string& bytes) { group_with("clique", bytes); }},
      {"mac", [](const std::string& bytes) { group_with("mac", bytes); }},
      {"tcf", [](const std::string& bytes) { group_with("tcf", bytes); }},
      {"gtm", [](const std::string& bytes) { group_with("gtm", bytes); }},
      {"cv", [](const std::string& bytes) { group_with("cv", bytes); }},
      {"frame-ransac", [](const std::string& bytes) { group_with("frame-ransac", bytes); }},
      {"refine", refine}};
  return all;
}

}  // namespace corral::fuzz
