// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "grouping/registry.h"

namespace corral {

/// Every method that answers with rows: groupers(), then "auto" and "register" (portfolio.h), which are made of several of them,
/// then those of plug-ins (load_plugin).
const std::vector<Grouper>& methods();

/// Throws InvalidInput for an unknown name, listing the known ones.
const Grouper& find_method(const std::string& name);

/// Adds a grouper of a shared library (grouping/plugin.h) to methods(), before any method is called. The same file may be given again.
/// Throws    IoError naming the file: it cannot be loaded, lacks one of the functions, is of another version (both are named), its
///           name or one of its options is none, or another method has that name.
void load_plugin(const std::string& file);

/// Whether its grouper was added.
bool is_loaded_plugin(const std::string& file);

/// The names of the methods of plug-ins, in the order in which they were loaded.
std::vector<std::string> plugin_methods();

/// The file of a method of a plug-in; empty for any other.
std::string plugin_file(const std::string& method);

}  // namespace corral
