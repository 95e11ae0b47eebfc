// SPDX-License-Identifier: MIT
#include "io/matches/feature_file.h"

#include <cmath>

#include "io/matches/named_arrays.h"
#include "kernel/error.h"

namespace corral {
namespace {

void check_finite_or_nan(const NumberTable& table) {
  for (int row = 0; row < table.size(); ++row)
    if (table.rows.col(row).array().isInf().any()) table.fail(row, "a number is infinite, expected finite ones");
}

/// The places of keypoints that are vertices.
Points places_of(const NumberTable& keypoints, const Points* vertices, Indices& indices) {
  if (!vertices)
    throw IoError(keypoints.path, "",
                  "has one number in a row, a vertex of the surface; expected x y z, or the surface beside it");
  for (int row = 0; row < keypoints.size(); ++row) {
    const double vertex = keypoints.rows(0, row);
    if (!(vertex >= 0 && vertex < static_cast<double>(vertices->rows()) && std::floor(vertex) == vertex))
      keypoints.fail(row, "a keypoint is not a vertex, expected 0 .. " + std::to_string(vertices->rows() - 1));
    indices.push_back(static_cast<int>(vertex));
  }
  return (*vertices)(indices, Eigen::all);
}

FeaturePoints of_one_table(const NumberTable& table) {
  if (table.width() < 4)
    table.fail(0, "found " + std::to_string(table.width()) +
                      " numbers, expected x y z and a feature; where the keypoints are in another file, name it");
  NumberTable keypoints, features;
  keypoints.path = features.path = table.path;
  keypoints.lines = features.lines = table.lines;
  keypoints.rows = table.rows.topRows(3);
  features.rows = table.rows.bottomRows(table.width() - 3);
  features.notes = table.notes;
  return features_of(keypoints, features);
}

}  // namespace

FeaturePoints features_of(const NumberTable& keypoints, const NumberTable& features, const Points* vertices) {
  if (keypoints.size() != features.size())
    throw IoError(features.path, "",
                  "has " + std::to_string(features.size()) + " rows, expected one for each of the " +
                      std::to_string(keypoints.size()) + " keypoints of " + keypoints.path);
  check_finite_or_nan(keypoints);
  check_finite_or_nan(features);
  FeaturePoints found;
  found.notes = keypoints.notes;
  found.notes.insert(found.notes.end(), features.notes.begin(), features.notes.end());
  if (keypoints.width() == 1) {
    found.points = places_of(keypoints, vertices, found.vertices);
  } else {
    if (keypoints.width() != 3)
      keypoints.fail(0, "found " + std::to_string(keypoints.width()) + " numbers, expected x y z or one vertex");
    found.points = keypoints.rows.transpose();
  }
  Indices kept;
  for (int row = 0; row < features.size(); ++row)
    if (!features.rows.col(row).hasNaN() && !found.points.row(row).hasNaN()) kept.push_back(row);
  found.features = features.rows;
  if (kept.empty()) throw IoError(features.path, "", "has no keypoint without a nan, expected features");
  if (static_cast<int>(kept.size()) < features.size()) {
    found.notes.push_back(std::to_string(features.size() - static_cast<int>(kept.size())) + " of " +
                          std::to_string(features.size()) + " keypoints left out: they hold a nan");
    found.points = Points(found.points(kept, Eigen::all));
    found.features = Eigen::MatrixXd(features.rows(Eigen::all, kept));
    if (!found.vertices.empty())
      for (std::size_t i = 0; i < kept.size(); ++i) found.vertices[i] = found.vertices[std::size_t(kept[i])];
    found.vertices.resize(found.vertices.empty() ? 0 : kept.size());
  }
  return found;
}

FeaturePoints read_features(const FeatureFiles& files) {
  if (!is_archive(files.features)) {
    const NumberTable features = read_number_table(files.features);
    return files.keypoints.empty() ? of_one_table(features)
                                   : features_of(read_number_table(files.keypoints), features, files.vertices);
  }
  NamedArrays arrays(files.features);
  const std::string features = arrays.own_features(), points = arrays.own_points();
  if (features.empty() || (points.empty() && files.keypoints.empty()))
    throw IoError(files.features, "",
                  "has the arrays " + arrays.unread() +
                      ", no keypoints and features under a known name, expected FILE:NAME for the features, and the "
                      "keypoints beside them");
  const NumberTable keypoints = files.keypoints.empty() ? arrays.read(points) : read_number_table(files.keypoints);
  return features_of(keypoints, arrays.read(features), files.vertices);
}

}  // namespace corral
