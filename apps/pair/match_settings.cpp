// SPDX-License-Identifier: MIT
#include "apps/pair/match_settings.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// Resolutions that differ by a larger factor have no meaningful mean: probably metres and millimetres.
constexpr double kLargestRatio = 20;

/// More than any machine needs; guards against typing errors.
constexpr int kMostThreads = 256;

constexpr char kShot[] = "shot";

/// A positive length, if the rule is one.
std::optional<double> as_length(const std::string& rule) {
  const auto value = parse_double(rule);
  return value && *value > 0 && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

std::vector<std::string> MatchSettings::in_use() const {
  std::vector<std::string> names = {detector, descriptor};
  if (frames == LocalFrames::Shot && descriptor != kShot) names.push_back(kShot);
  return names;
}

OptionOverrides MatchSettings::options_of(const std::string& name) const {
  const auto found = options.find(name);
  return found == options.end() ? OptionOverrides() : found->second;
}

void MatchSettings::validate() const {
  if (resolution != "mean" && resolution != "source" && resolution != "target" && !as_length(resolution))
    throw InvalidInput("match", "--resolution", "'" + resolution + "'",
                       "mean|source|target or a length above zero in mesh units");
  if ((!sensor.empty() && sensor.size() != 3) ||
      !std::all_of(sensor.begin(), sensor.end(), [](double x) { return std::isfinite(x); }))
    throw InvalidInput("match", "--sensor", "not a point", "three finite coordinates x,y,z");
  if (threads < 0 || threads > kMostThreads)
    throw InvalidInput("match", "--threads", std::to_string(threads), "0 .. " + std::to_string(kMostThreads));
  if (!look_up(detectors(), detector))
    throw InvalidInput("match", "--detector", "'" + detector + "'", names_of(detectors()));
  if (!look_up(descriptors(), descriptor))
    throw InvalidInput("match", "--descriptor", "'" + descriptor + "'", names_of(descriptors()));
  const std::vector<std::string> used = in_use();
  for (const auto& [name, overrides] : options)
    if (!overrides.empty() && std::find(used.begin(), used.end(), name) == used.end())
      throw InvalidInput("match", "an option", "that of '" + name + "', which is not in use",
                         "those of the detector " + detector + " or the descriptor " + descriptor);
  for (const std::string& name : used) surface_options(*this, name);
}

NormalOptions MatchSettings::normal_options() const {
  NormalOptions chosen;
  chosen.side = normals;
  if (!sensor.empty()) chosen.sensor = Eigen::Vector3d(sensor.data());
  return chosen;
}

std::vector<OptionValue> surface_options(const MatchSettings& settings, const std::string& name) {
  if (const Detector* entry = look_up(detectors(), name)) return entry->configure(settings.options_of(name)).options;
  if (const Descriptor* entry = look_up(descriptors(), name))
    return entry->configure(settings.options_of(name)).options;
  return {};
}

OptionValue keypoint_length(const MatchSettings& settings) {
  for (const OptionValue& option : settings.configured_detector().options)
    if (option.unit == "pr") return option;
  return {};
}

Json to_json(const MatchSettings& settings) {
  Json json = {{"resolution_rule", settings.resolution},
               {"detector", settings.detector},
               {"descriptor", settings.descriptor},
               {"options", Json::object()},
               {"sensor", settings.sensor.empty() ? Json(nullptr) : Json(settings.sensor)}};
  for (const std::string& name : settings.in_use()) json["options"][name] = to_json(surface_options(settings, name));
  for (const OptionValue& field : describe_options(settings)) json[field.name] = typed(field.value);
  return json;
}

double pair_resolution(const std::string& rule, double source, double target, const std::string& remark) {
  if (rule == "source") return source;
  if (rule == "target") return target;
  if (rule == "mean") {
    const double ratio = std::max(source, target) / std::min(source, target);
    if (!(ratio <= kLargestRatio))
      throw InvalidInput("match", "pr", to_text(source) + " on the source and " + to_text(target) + " on the target",
                         "both in the same unit (units differ by a factor of " + to_text(std::round(ratio)) +
                             ", if the surfaces are alike), or one that --resolution sets" + remark);
    return (source + target) / 2;
  }
  return as_length(rule).value();
}

}  // namespace corral
