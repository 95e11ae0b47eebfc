// SPDX-License-Identifier: MIT
#include "apps/runtime/json.h"

#include "kernel/number_text.h"

namespace corral {

Json to_json(const RigidTransform& transform) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row)
    rows.push_back({transform.rotation(row, 0), transform.rotation(row, 1), transform.rotation(row, 2),
                    transform.translation(row)});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

Json typed(const std::string& value) {
  if (value == "true" || value == "false") return value == "true";
  if (const auto whole = parse_unsigned(value)) return *whole;
  if (const auto number = parse_double(value)) return *number;
  return value;
}

Json to_json(const std::vector<OptionValue>& options) {
  Json json = Json::object();
  for (const OptionValue& option : options) json[option.name] = typed(option.value);
  return json;
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

std::string compact_json(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace corral
