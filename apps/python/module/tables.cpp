// SPDX-License-Identifier: MIT
#include <utility>

#include "apps/python/module/arrays.h"
#include "apps/python/module/parts.h"
#include "apps/runtime/stopwatch.h"
#include "grouping/registry.h"
#include "kernel/synthetic.h"

namespace corral::python {
namespace {

CorrespondenceSet make_table(const py::object& source_points, const py::object& target_points,
                             const py::object& resolution, const py::object& feature_distance,
                             const py::object& second_feature_distance, const py::object& source_frames,
                             const py::object& target_frames, const py::object& source_centroid) {
  CorrespondenceSet table;
  table.source_points = points_of(source_points, "source_points");
  table.target_points = points_of(target_points, "target_points");
  table.resolution = number_of(resolution, "resolution");
  if (!feature_distance.is_none()) table.feature_distance = column_of(feature_distance, "feature_distance");
  if (!second_feature_distance.is_none())
    table.second_feature_distance = column_of(second_feature_distance, "second_feature_distance");
  if (!source_frames.is_none()) table.source_frames = frames_of(source_frames, "source_frames");
  if (!target_frames.is_none()) table.target_frames = frames_of(target_frames, "target_frames");
  table.source_centroid = unless_none(source_centroid, "source_centroid", place_of);
  table.validate();
  return table;
}

/// A column as an array on the table's memory; None for an absent one.
template <class Column>
auto column(Column CorrespondenceSet::*member) {
  return [member](const py::object& self) -> py::object {
    const Column& values = self.cast<const CorrespondenceSet&>().*member;
    if (values.size() == 0 && !std::is_same_v<Column, Points>) return py::none();
    return view_of(values, self);
  };
}

py::tuple group(const CorrespondenceSet& table, const std::string& method, const py::dict& options) {
  const ConfiguredGrouper grouper = find_grouper(method).configure(overrides_of(options, method));
  GroupingResult found;
  double time_ms = 0;
  {
    const py::gil_scoped_release released;
    Stopwatch watch;
    found = grouper.group(table);
    time_ms = watch.lap_ms();
  }
  py::list runner_up;
  for (const ScoredPose& pose : found.runner_up)
    runner_up.append(py::make_tuple(array_of(pose.target_from_source), pose.score));
  py::dict notes;
  for (const Note& note : found.notes) notes[py::str(note.name)] = note.count;
  return py::make_tuple(array_of(found.selected),
                        found.scores.empty() ? py::object(py::none()) : py::object(array_of(found.scores)),
                        or_none(found.target_from_source), runner_up, notes, time_ms / 1000);
}

py::list list_groupers() {
  py::list list;
  for (const Grouper& grouper : groupers()) {
    py::list options;
    for (const OptionValue& option : grouper.options)
      options.append(py::make_tuple(option.name, option.value, option.unit, option.accepted, option.meaning));
    list.append(py::make_tuple(grouper.name, grouper.title, grouper.principle, grouper.citation, options));
  }
  return list;
}

py::tuple make_synthetic(const SyntheticOptions& options) {
  SyntheticProblem problem;
  {
    const py::gil_scoped_release released;
    problem = make_synthetic_problem(options);
  }
  return py::make_tuple(std::move(problem.matches), array_of(problem.truth));
}

}  // namespace

void add_tables(py::module_& module) {
  py::class_<CorrespondenceSet>(module, "Table")
      .def(py::init(&make_table))
      .def("__len__", &CorrespondenceSet::size)
      .def_property_readonly("source_points", column(&CorrespondenceSet::source_points))
      .def_property_readonly("target_points", column(&CorrespondenceSet::target_points))
      .def_property_readonly("source_frames", column(&CorrespondenceSet::source_frames))
      .def_property_readonly("target_frames", column(&CorrespondenceSet::target_frames))
      .def_property_readonly("source_keypoints", column(&CorrespondenceSet::source_keypoints))
      .def_property_readonly("target_keypoints", column(&CorrespondenceSet::target_keypoints))
      .def_property_readonly("feature_distance", column(&CorrespondenceSet::feature_distance))
      .def_property_readonly("second_feature_distance", column(&CorrespondenceSet::second_feature_distance))
      .def_readonly("resolution", &CorrespondenceSet::resolution)
      .def_property_readonly("source_centroid", [](const CorrespondenceSet& self) -> py::object {
        if (!self.source_centroid) return py::none();
        return py::array_t<double>(3, self.source_centroid->data());
      });
  module.def("group", &group);
  module.def("groupers", &list_groupers);
  module.def("make_synthetic", [](int matches, double inlier_ratio, double noise_pr, double extent_pr,
                                  double frame_noise_deg, double resolution, std::uint64_t seed) {
    return make_synthetic({matches, inlier_ratio, noise_pr, extent_pr, frame_noise_deg, resolution, seed});
  });
}

}  // namespace corral::python
