// SPDX-License-Identifier: MIT
// Where views were taken, as several commands ask for it.
#include <cmath>

#include "apps/commands/commands.h"
#include "kernel/number_text.h"

namespace corral {

Eigen::Vector3d parse_vector(const std::string& option, const std::string& text) {
  Eigen::Vector3d vector;
  std::size_t begin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? text.find(',', begin) : text.size();
    const std::optional<double> number =
        end == std::string::npos ? std::nullopt : parse_double(std::string_view(text).substr(begin, end - begin));
    if (!number || !std::isfinite(*number))
      throw UsageError(option + ": found '" + text + "', expected three finite numbers x,y,z");
    vector(axis) = *number;
    begin = end + 1;
  }
  return vector;
}

void add_sensor_options(CLI::App& command, SensorSettings& settings) {
  auto* sensor = command.add_option("--sensor", settings.sensor, "Position of the sensor, mesh units")
                     ->type_name("X,Y,Z")
                     ->capture_default_str();
  command
      .add_option("--direction", settings.direction,
                  "The way the sensor looks, if it is far away or its position unknown")
      ->type_name("X,Y,Z")
      ->excludes(sensor);
}

ViewOptions view_options(const SensorSettings& settings) {
  ViewOptions options;
  options.sensor = parse_vector("--sensor", settings.sensor);
  if (settings.direction) {
    options.direction = parse_vector("--direction", *settings.direction);
    if (options.direction->isZero(0)) throw UsageError("--direction: expected a vector that is not zero");
  }
  return options;
}

}  // namespace corral
