// SPDX-License-Identifier: MIT
// Poses in JSON objects: BOP's scene_gt.json, and matrices by name.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/pose/pose_entry.h"
#include "kernel/error.h"

namespace corral {
namespace {

using Json = nlohmann::json;

/// How deep brackets and braces are nested, those in strings aside.
int nesting(const std::string& content) {
  int depth = 0, deepest = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < content.size(); ++i) {
    const char letter = content[i];
    if (is_string && letter == '\\')
      ++i;
    else if (letter == '"')
      is_string = !is_string;
    else if (!is_string && (letter == '[' || letter == '{'))
      deepest = std::max(deepest, ++depth);
    else if (!is_string && (letter == ']' || letter == '}'))
      --depth;
  }
  return deepest;
}

Json parse_document(const std::string& path, const std::string& content) {
  constexpr int kDeepest = 50;  // more would overflow the stack when the value is released or copied
  if (nesting(content) > kDeepest) throw IoError(path, "", "is nested more than 50 deep, expected poses");
  try {
    return Json::parse(content);
  } catch (const Json::parse_error& error) {
    throw IoError(path, "byte " + std::to_string(error.byte), "is not valid JSON");
  } catch (const Json::exception&) {
    throw IoError(path, "", "holds a number that is too large, expected finite ones");
  }
}

/// Appends the numbers of an array, or of an array of arrays; false if there is anything else in it.
bool collect(const Json& value, int depth, std::vector<double>& numbers) {
  if (!value.is_array() || depth > 2) return false;
  for (const Json& each : value) {
    if (each.is_number())
      numbers.push_back(each.get<double>());
    else if (!collect(each, depth + 1, numbers))
      return false;
  }
  return true;
}

/// The numbers of a matrix of so many entries; none if the value is something else.
std::vector<double> matrix_of(const Json& value, std::size_t count) {
  std::vector<double> numbers;
  return collect(value, 1, numbers) && numbers.size() == count ? numbers : std::vector<double>();
}

bool is_bop(const Json& document) {
  for (const Json& image : document)
    if (image.is_array() && !image.empty() && image[0].is_object() && image[0].contains("cam_R_m2c")) return true;
  return false;
}

PoseEntry instance_of(const std::string& path, const Json& instance, const std::string& image, std::size_t number) {
  const std::string name = image + "/" + std::to_string(number);
  const auto numbers = [&](const char* key, std::size_t count) {
    if (!instance.is_object() || !instance.contains(key)) throw IoError(path, name, std::string("has no ") + key);
    std::vector<double> found = matrix_of(instance[key], count);
    if (found.empty())
      throw IoError(path, name, std::string(key) + ": expected an array of " + std::to_string(count) + " numbers");
    return found;
  };
  const std::vector<double> r = numbers("cam_R_m2c", 9), t = numbers("cam_t_m2c", 3);
  return {name, "", image, name, {r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2]}};
}

}  // namespace

std::vector<PoseEntry> parse_pose_json(const std::string& path, const std::string& content) {
  const Json document = parse_document(path, content);
  std::vector<PoseEntry> entries;
  const bool has_images = is_bop(document);
  for (const auto& [name, value] : document.items()) {
    if (has_images) {
      if (!value.is_array()) throw IoError(path, name, "expected an array of instances");
      for (std::size_t i = 0; i < value.size(); ++i) entries.push_back(instance_of(path, value[i], name, i));
      continue;
    }
    for (const std::size_t count : {16, 12}) {
      const std::vector<double> numbers = matrix_of(value, count);
      if (!numbers.empty()) entries.push_back({name, "", "", name, numbers});
    }
  }
  if (entries.empty())
    throw IoError(path, "", "has no pose, expected BOP's images with cam_R_m2c and cam_t_m2c, or 4x4 matrices by name");
  return entries;
}

}  // namespace corral
