// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "apps/pair/confidence_file.h"
#include "apps/pair/load_pair.h"
#include "apps/pair/match_pair.h"
#include "apps/pair/match_report.h"
#include "apps/python/module/arrays.h"
#include "apps/python/module/parts.h"
#include "apps/python/module/records.h"
#include "apps/runtime/workers.h"
#include "io/matches/matches_file.h"
#include "io/mesh/mesh_file.h"

namespace corral::python {
namespace {

py::array numbers_of(Points points) {
  return owned(std::move(points), [](const Points& kept, const py::handle& owner) {
    return py::array_t<double>({kept.rows(), py::ssize_t{3}},
                               {py::ssize_t{sizeof(double)}, py::ssize_t{sizeof(double)} * kept.rows()}, kept.data(),
                               owner);
  });
}

py::array numbers_of(Triangles triangles) {
  return owned(std::move(triangles), [](const Triangles& kept, const py::handle& owner) {
    return py::array_t<int>({kept.rows(), py::ssize_t{3}},
                            {py::ssize_t{sizeof(int)}, py::ssize_t{sizeof(int)} * kept.rows()}, kept.data(), owner);
  });
}

py::tuple read(const std::string& path) {
  StoredMesh mesh;
  {
    const py::gil_scoped_release released;
    mesh = read_mesh(path);
  }
  py::object normals = py::none(), sensor = py::none();
  if (mesh.normals.rows() > 0) normals = numbers_of(std::move(mesh.normals));
  if (mesh.sensor) sensor = py::array_t<double>(3, mesh.sensor->data());
  return py::make_tuple(numbers_of(std::move(mesh.vertices)), numbers_of(std::move(mesh.triangles)), normals, sensor,
                        mesh.notes);
}

/// vertices, triangles, normals and sensor, the last three None where there are none.
Mesh mesh_of(const py::tuple& parts, const std::string& side) {
  const auto named = [&](const char* part) { return side + "." + part; };
  Mesh mesh;
  mesh.vertices = points_of(parts[0], named("vertices").c_str());
  mesh.triangles.resize(0, 3);
  if (!parts[1].is_none()) mesh.triangles = triangles_of(parts[1], named("triangles").c_str());
  if (!parts[2].is_none()) mesh.normals = points_of(parts[2], named("normals").c_str());
  mesh.sensor = unless_none(parts[3], named("sensor").c_str(), place_of);
  return mesh;
}

/// A setting that is a choice or a flag.
void set_fields(MatchSettings& settings, const py::dict& choices) {
  const OptionOverrides texts = overrides_of(choices, "match");
  MatchSettings::visit_fields(settings, [&](const OptionField& field, auto& value) {
    const auto found = texts.find(field.name);
    if (found != texts.end() && !detail::parse_value(found->second, value))
      detail::reject_option("match", field.name, "'" + found->second + "'",
                            detail::accepted_values<std::decay_t<decltype(value)>>(field));
  });
}

py::tuple match(const py::tuple& source, const py::tuple& target, const std::string& resolution,
                const std::string& detector, const std::string& descriptor, const py::dict& choices,
                const py::object& sensor, const py::dict& options, int threads) {
  const Mesh first = mesh_of(source, "source"), second = mesh_of(target, "target");
  MatchSettings settings;
  settings.resolution = resolution;
  settings.detector = detector;
  settings.descriptor = descriptor;
  set_fields(settings, choices);
  if (const auto place = unless_none(sensor, "sensor", place_of))
    settings.sensor = {(*place)(0), (*place)(1), (*place)(2)};
  for (const auto& [name, values] : options) {
    const auto key = name.cast<std::string>();
    settings.options[key] = overrides_of(values.cast<py::dict>(), key);
  }
  settings.threads = threads;
  settings.validate();
  MatchedPair found;
  {
    const py::gil_scoped_release released;
    found = match_pair(first, second, settings);
  }
  return py::make_tuple(std::move(found.matches), as_python(to_json(found.report)), advice(found.report));
}

/// The best pose of a pair, what weighs for it, and the poses beside it.
py::dict as_dict(const Registration& found, const ConfidenceModel& model) {
  py::dict dict;
  py::list others;
  for (std::size_t i = 1; i < found.poses.size(); ++i)
    others.append(or_none(std::optional(found.poses[i].target_from_source)));
  dict["pose"] =
      found.poses.empty() ? py::object(py::none()) : or_none(std::optional(found.poses[0].target_from_source));
  dict["others"] = others;
  dict["method"] = found.poses.empty() ? py::object(py::none()) : py::cast(found.poses[0].method);
  dict["confidence"] = found.signals ? py::cast(model.probability(*found.signals)) : py::object(py::none());
  dict["verdict"] = found.signals ? py::cast(verdict(model.probability(*found.signals))) : py::object(py::none());
  py::dict signals;
  if (found.signals)
    for (std::size_t i = 0; i < kSignals; ++i) signals[kSignalNames[i]] = (*found.signals)[i];
  dict["signals"] = signals;
  return dict;
}

/// `source` and `target` may both be None: then the table alone decides.
py::dict register_surfaces(const CorrespondenceSet& table, const py::object& source, const py::object& target,
                           int threads) {
  const bool has_surfaces = !source.is_none() && !target.is_none();
  std::optional<PairMeshes> meshes;
  if (has_surfaces) meshes = {mesh_of(source.cast<py::tuple>(), "source"), mesh_of(target.cast<py::tuple>(), "target")};
  Registration found;
  {
    const py::gil_scoped_release released;
    std::optional<RegisteredSurfaces> surfaces;
    if (meshes) surfaces.emplace(meshes->surfaces());
    found = register_pair(table, surfaces, workers(threads));
  }
  return as_dict(found, has_surfaces ? built_in_confidence().surfaces : built_in_confidence().table);
}

}  // namespace

void add_surfaces(py::module_& module) {
  module.def("read_mesh", &read);
  module.def("match", &match);
  module.def("register", &register_surfaces);
  module.def(
      "read_matches", [](const std::string& path) { return read_matches(path); },
      py::call_guard<py::gil_scoped_release>());
}

}  // namespace corral::python
