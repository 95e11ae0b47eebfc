// SPDX-License-Identifier: MIT
#include "apps/python/module/parts.h"
#include "kernel/error.h"

namespace py = pybind11;

namespace {

/// An exception of Python for one of ours, named after the package and not after this module in it.
template <class Error>
void add_error(py::module_& module, const char* name, PyObject* base) {
  const std::string inner = module.attr("__name__").cast<std::string>();
  py::register_exception<Error>(module, name, base).attr("__module__") = inner.substr(0, inner.rfind('.'));
}

}  // namespace

PYBIND11_MODULE(_corral, module) {
  add_error<corral::InvalidInput>(module, "InvalidInput", PyExc_ValueError);
  add_error<corral::IoError>(module, "IoError", PyExc_OSError);
  corral::python::add_tables(module);
  corral::python::add_scores(module);
#ifdef CORRAL_FULL
  corral::python::add_surfaces(module);
  corral::python::add_poses(module);
#endif
}
