// SPDX-License-Identifier: MIT
#include "kernel/correspondence_set.h"

#include <cmath>

#include "kernel/all_finite.h"
#include "kernel/error.h"
#include "kernel/missing_column.h"

namespace corral {
namespace {

void check_length(const char* name, std::size_t length, int expected, bool optional) {
  if (length == static_cast<std::size_t>(expected) || (optional && length == 0)) return;
  throw InvalidInput("table of matches", std::string("column ") + name, std::to_string(length) + " rows long",
                     std::to_string(expected) + " rows" + (optional ? " or none" : ""));
}

template <class Matrix>
void check_finite(const char* name, const Matrix& values) {
  if (all_finite(values.data(), values.size())) return;
  for (Eigen::Index row = 0; row < values.rows(); ++row)
    for (Eigen::Index column = 0; column < values.cols(); ++column)
      if (!std::isfinite(values(row, column)))
        throw InvalidInput("table of matches", std::string(name) + " of row " + std::to_string(row),
                           values(row, column), "a finite number");
}

void check_frames(const char* name, const LocalReferenceFrames& frames) {
  if (frames.empty() || all_finite(frames.front().data(), 9 * static_cast<Eigen::Index>(frames.size()))) return;
  for (std::size_t row = 0; row < frames.size(); ++row)
    if (!frames[row].allFinite())
      throw InvalidInput("table of matches", std::string(name) + " of row " + std::to_string(row), "not finite",
                         "nine finite numbers");
}

}  // namespace

Eigen::Vector3d CorrespondenceSet::source_centroid_or_mean() const {
  if (source_centroid) return *source_centroid;
  if (size() == 0) return Eigen::Vector3d::Zero();
  return source_points.colwise().mean().transpose();
}

void CorrespondenceSet::validate() const {
  const int rows = size();
  check_length("target_points", static_cast<std::size_t>(target_points.rows()), rows, false);
  check_length("source_frames", source_frames.size(), rows, true);
  check_length("target_frames", target_frames.size(), rows, true);
  check_length("source_keypoints", source_keypoints.size(), rows, true);
  check_length("target_keypoints", target_keypoints.size(), rows, true);
  check_length("feature_distance", static_cast<std::size_t>(feature_distance.size()), rows, true);
  check_length("second_feature_distance", static_cast<std::size_t>(second_feature_distance.size()), rows, true);
  require_positive("table of matches", "resolution", resolution);
  check_finite("source_points", source_points);
  check_finite("target_points", target_points);
  check_finite("feature_distance", feature_distance);
  check_finite("second_feature_distance", second_feature_distance);
  check_frames("source_frames", source_frames);
  check_frames("target_frames", target_frames);
  if (source_centroid) check_finite("source_centroid", Eigen::Matrix<double, 1, 3>(source_centroid->transpose()));
}

void check_rows(const CorrespondenceSet& matches, const Indices& rows, const std::string& who) {
  for (const int row : rows)
    if (row < 0 || row >= matches.size())
      throw InvalidInput(who, "row", std::to_string(row), "one of " + std::to_string(matches.size()) + " rows from 0");
}

CorrespondenceSet select_rows(const CorrespondenceSet& matches, const Indices& rows) {
  check_rows(matches, rows, "select_rows");
  CorrespondenceSet chosen;
  chosen.source_points = matches.source_points(rows, Eigen::all);
  chosen.target_points = matches.target_points(rows, Eigen::all);
  const auto pick = [&](const auto& from, auto& to) {
    if (from.size() == 0) return;
    to.resize(static_cast<decltype(to.size())>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
      to[static_cast<decltype(to.size())>(i)] = from[static_cast<decltype(from.size())>(rows[i])];
  };
  pick(matches.source_frames, chosen.source_frames);
  pick(matches.target_frames, chosen.target_frames);
  pick(matches.source_keypoints, chosen.source_keypoints);
  pick(matches.target_keypoints, chosen.target_keypoints);
  pick(matches.feature_distance, chosen.feature_distance);
  pick(matches.second_feature_distance, chosen.second_feature_distance);
  chosen.resolution = matches.resolution;
  chosen.source_centroid = matches.source_centroid;
  return chosen;
}

void require_columns(const CorrespondenceSet& matches, const std::string& who, std::initializer_list<Column> columns) {
  matches.validate();
  if (matches.size() == 0) return;
  for (const Column column : columns) {
    const char* name = "";
    bool absent = false;
    switch (column) {
      case Column::SourceFrames:
        name = "source_frames", absent = matches.source_frames.empty();
        break;
      case Column::TargetFrames:
        name = "target_frames", absent = matches.target_frames.empty();
        break;
      case Column::FeatureDistance:
        name = "feature_distance", absent = matches.feature_distance.size() == 0;
        break;
      case Column::SecondFeatureDistance:
        name = "second_feature_distance", absent = matches.second_feature_distance.size() == 0;
        break;
    }
    const bool is_frame = column == Column::SourceFrames || column == Column::TargetFrames;
    if (absent)
      throw MissingColumn(
          who, std::string("column ") + name, "absent",
          is_frame ? "nine values per match (in a file: the columns _frame_0 .. _frame_8)" : "one value per match");
  }
}

}  // namespace corral
