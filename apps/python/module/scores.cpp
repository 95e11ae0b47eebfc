// SPDX-License-Identifier: MIT
#include "apps/python/module/arrays.h"
#include "apps/python/module/parts.h"
#include "kernel/evaluation.h"

namespace corral::python {
namespace {

/// Adds the errors of a pose, as those of a table without surfaces are taken: the mean over the source points of the correct
/// matches, the root mean square over those of all.
void add_errors(py::dict& score, const CorrespondenceSet& table, const std::optional<RigidTransform>& pose,
                const RigidTransform& truth, const std::vector<bool>& labels) {
  std::optional<double> rotation, translation, mean, rmse;
  if (pose) {
    Indices correct;
    for (std::size_t row = 0; row < labels.size(); ++row)
      if (labels[row]) correct.push_back(static_cast<int>(row));
    rotation = rotation_error_deg(*pose, truth);
    translation = translation_error_pr(*pose, truth, table.resolution);
    const Points judged = table.source_points(correct, Eigen::all);
    if (const auto error = point_error(*pose, truth, judged, table.resolution)) {
      mean = error->mean_pr;
      rmse = point_error(*pose, truth, table.source_points, table.resolution)->rmse_pr;
    }
  }
  score["rotation_error_deg"] = or_none(rotation);
  score["translation_error_pr"] = or_none(translation);
  score["mean_error_pr"] = or_none(mean);
  score["rmse_pr"] = or_none(rmse);
}

py::dict score(const CorrespondenceSet& table, const py::object& selected, const py::object& truth,
               const py::object& pose, const py::object& threshold_pr) {
  const RigidTransform right = pose_of(truth, "truth");
  const Indices rows = rows_of(selected, "selected");
  const std::vector<bool> labels = label_correct(table, right, number_of(threshold_pr, "threshold_pr"));
  const GroupingScore found = score_grouping(labels, rows);
  std::optional<RigidTransform> estimate = unless_none(pose, "pose", pose_of);
  if (!estimate) estimate = fit_rigid_transform(table, rows);
  py::dict score;
  score["matches"] = found.matches;
  score["selected"] = found.selected;
  score["correct"] = found.correct;
  score["true_matches"] = found.true_matches;
  score["precision"] = or_none(found.precision);
  score["recall"] = or_none(found.recall);
  score["f1"] = or_none(found.f1);
  add_errors(score, table, estimate, right, labels);
  return score;
}

}  // namespace

void add_scores(py::module_& module) {
  module.def("score", &score);
  module.def("label_correct",
             [](const CorrespondenceSet& table, const py::object& truth, const py::object& threshold_pr) {
               return array_of(label_correct(table, pose_of(truth, "truth"), number_of(threshold_pr, "threshold_pr")));
             });
}

}  // namespace corral::python
