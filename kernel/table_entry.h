// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernel/error.h"
#include "kernel/options.h"

namespace corral {

/// An algorithm as the command line, the tests and the documents know it. Groupers, detectors and descriptors are tables of
/// these; `Configured` is the function with its options bound.
template <class Configured>
struct TableEntry {
  std::string name;                                             ///< as on the command line: "gc"
  std::string title;                                            ///< "Geometric consistency (GC)"
  std::string principle;                                        ///< one line
  std::string citation;                                         ///< key in paper/references.bib; may be empty
  std::vector<OptionValue> options;                             ///< the defaults
  std::function<Configured(const OptionOverrides&)> configure;  ///< throws InvalidInput as parse_options does
};

/// The entry of a name, or null.
template <class Entry>
const Entry* look_up(const std::vector<Entry>& table, const std::string& name) {
  for (const Entry& entry : table)
    if (entry.name == name) return &entry;
  return nullptr;
}

/// The names of a table with something between them, in its order.
template <class Entry>
std::string names_of(const std::vector<Entry>& table, const std::string& separator = "|") {
  std::string names;
  for (const Entry& entry : table) names += (names.empty() ? "" : separator) + entry.name;
  return names;
}

/// The entry of a name; `kind` is what the table holds, such as "grouper". Throws InvalidInput listing the known names.
template <class Entry>
const Entry& find_entry(const std::vector<Entry>& table, const std::string& kind, const std::string& name) {
  if (const Entry* entry = look_up(table, name)) return *entry;
  throw InvalidInput(kind, "name", "'" + name + "'", names_of(table));
}

}  // namespace corral
