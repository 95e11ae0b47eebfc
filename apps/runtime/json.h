// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kernel/options.h"
#include "kernel/rigid_transform.h"

namespace corral {

using Json = nlohmann::ordered_json;  // keys stay in the order of the documentation

template <class Value>
Json json_or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json to_json(const RigidTransform& transform);          ///< four rows of four
Json to_json(const std::vector<OptionValue>& options);  ///< name -> value
Json typed(const std::string& value);                   ///< a bool, a number or else the text itself

/// Indented, on lines of its own; bytes that are no UTF-8 (file names may hold any) are replaced.
std::string json_text(const Json& json);

/// On one line, for keys and files of the program's own.
std::string compact_json(const Json& json);

}  // namespace corral
