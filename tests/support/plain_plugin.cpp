// SPDX-License-Identifier: MIT
// A grouper as plain double loops, as a plug-in: `plain-gc` beside `gc`, and so on, with the options of the paper. For statements
// about time, which the paper made of such loops. CORRAL_PLAIN_NAME and CORRAL_PLAIN_FORM say which one.
#include <algorithm>
#include <exception>
#include <string>

#include "grouping/plugin.h"
#include "tests/support/reference/groupers.h"

namespace corral {
namespace {

Points points_of(const double* const columns[3], int rows) {
  Points points(rows, 3);
  for (int axis = 0; axis < 3; ++axis) points.col(axis) = Eigen::Map<const Eigen::VectorXd>(columns[axis], rows);
  return points;
}

Eigen::VectorXd numbers_of(const double* column, int rows) {
  return column ? Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(column, rows)) : Eigen::VectorXd();
}

std::vector<LocalReferenceFrame> frames_of(const double* frames, int rows) {
  std::vector<LocalReferenceFrame> made;
  for (int row = 0; frames && row < rows; ++row)
    made.push_back(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frames + 9 * row));
  return made;
}

CorrespondenceSet matches_of(const corral_table& table) {
  CorrespondenceSet matches;
  matches.source_points = points_of(table.source, table.rows);
  matches.target_points = points_of(table.target, table.rows);
  matches.resolution = table.resolution;
  matches.feature_distance = numbers_of(table.feature_distance, table.rows);
  matches.second_feature_distance = numbers_of(table.second_feature_distance, table.rows);
  matches.source_frames = frames_of(table.source_frames, table.rows);
  matches.target_frames = frames_of(table.target_frames, table.rows);
  matches.source_centroid = Eigen::Map<const Eigen::Vector3d>(table.source_centroid);
  return matches;
}

}  // namespace
}  // namespace corral

int corral_plugin_version() { return CORRAL_PLUGIN_VERSION; }
const char* corral_plugin_name() { return CORRAL_PLAIN_NAME; }
const char* corral_plugin_options() { return ""; }

const char* corral_plugin_group(const corral_table* table, const char*, corral_answer* answer) {
  static thread_local std::string complaint;
  try {
    for (const int row : corral::reference::CORRAL_PLAIN_FORM(corral::matches_of(*table), {}).rows)
      answer->selected[row] = 1;
    return nullptr;
  } catch (const std::exception& error) {
    complaint = error.what();
    return complaint.c_str();
  }
}
