// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <algorithm>

#include "apps/pair/evaluate_pair.h"
#include "apps/pair/methods.h"
#include "apps/pair/portfolio.h"
#include "apps/pair/report_pair.h"
#include "apps/python/module/arrays.h"
#include "apps/python/module/parts.h"
#include "apps/python/module/records.h"

namespace corral::python {
namespace {

py::dict as_dict(const RefinedPose& refined) {
  const bool has_pose = refined.target_from_source.has_value();
  const auto number = [](double value, bool is_known) { return is_known ? py::cast(value) : py::object(py::none()); };
  py::dict dict;
  dict["pose"] = or_none(refined.target_from_source);
  dict["status"] = to_text(refined.status);
  dict["converged"] = refined.converged;
  dict["iterations"] = refined.iterations;
  dict["initial"] = or_none(refined.initial);
  dict["initial_rms_pr"] = number(refined.initial_rms_pr, refined.initial.has_value());
  dict["final_rms_pr"] = number(refined.final_rms_pr, has_pose);
  dict["initial_cost"] = number(refined.initial_cost, refined.initial.has_value());
  dict["final_cost"] = number(refined.final_cost, has_pose);
  dict["condition"] = or_none(refined.condition);
  dict["covariance"] = py::none();
  if (refined.covariance) dict["covariance"] = py::array_t<double>({6, 6}, refined.covariance->data());  // symmetric
  return dict;
}

RobustLoss loss_of(const std::string& name) {
  RobustLoss loss;
  if (!detail::parse_value(name, loss))
    throw InvalidInput("refine", "loss", "'" + name + "'", detail::accepted_text(detail::choices<RobustLoss>()));
  return loss;
}

py::dict refine(const CorrespondenceSet& table, const py::object& selected, const std::string& loss,
                const py::object& loss_scale_pr, int maximum_iterations, const py::object& start) {
  const RefineOptions options{loss_of(loss), number_of(loss_scale_pr, "loss_scale_pr"), maximum_iterations};
  const Indices rows = rows_of(selected, "selected");
  const std::optional<RigidTransform> from = unless_none(start, "start", pose_of);
  RefinedPose refined;
  {
    const py::gil_scoped_release released;
    refined = refine_rigid(table, rows, options, from);
  }
  return as_dict(refined);
}

py::dict refine_all(const CorrespondenceSet& table, const py::object& start) {
  const RigidTransform from = pose_of(start, "start");
  RefinedPose refined;
  {
    const py::gil_scoped_release released;
    refined = refine_over_all(table, from);
  }
  return as_dict(refined);
}

/// Each grouper once, with its options.
std::vector<std::pair<std::string, ConfiguredGrouper>> configured(const std::vector<std::string>& names,
                                                                  const py::dict& options) {
  std::vector<std::pair<std::string, ConfiguredGrouper>> groupers;
  std::vector<std::string> unused;
  for (const auto& [name, values] : options) unused.push_back(name.cast<std::string>());
  for (const std::string& name : expand_groupers(names)) {
    for (const auto& [other, grouper] : groupers)
      if (other == name) throw InvalidInput("evaluate_table", "methods", "with " + name + " twice", "each once");
    const py::dict values = options.contains(name) ? py::dict(options[name.c_str()]) : py::dict();
    groupers.emplace_back(name, find_method(name).configure(overrides_of(values, name)));
    unused.erase(std::remove(unused.begin(), unused.end(), name), unused.end());
  }
  if (!unused.empty())
    throw InvalidInput("evaluate_table", "options", "with " + unused.front(), "names that methods has");
  return groupers;
}

py::list evaluate(const CorrespondenceSet& table, const py::object& truth, const std::vector<std::string>& methods,
                  const py::dict& options, const py::object& threshold_pr, int repeat) {
  if (repeat < 1) throw InvalidInput("evaluate_table", "repeat", std::to_string(repeat), "at least 1");
  const RigidTransform right = pose_of(truth, "truth");
  const double threshold = number_of(threshold_pr, "threshold_pr");
  const auto groupers = configured(methods, options);
  std::vector<MethodRecord> records;
  {
    const py::gil_scoped_release released;
    const PairTruth judged = table_truth(table, right, threshold);
    for (const auto& [name, grouper] : groupers)
      records.push_back(evaluate_method(name, grouper, table, judged, repeat));
    rate_poses(records, table);
    for (MethodRecord& bound : evaluate_bounds(table, judged)) records.push_back(std::move(bound));
  }
  py::list list;
  for (const MethodRecord& record : records) list.append(as_python(to_json(record)));
  return list;
}

}  // namespace

void add_poses(py::module_& module) {
  module.def("refine", &refine);
  module.def("refine_over_all", &refine_all);
  module.def("evaluate_table", &evaluate);
}

}  // namespace corral::python
