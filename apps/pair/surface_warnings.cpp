// SPDX-License-Identifier: MIT
#include "apps/pair/surface_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "apps/runtime/text_table.h"

namespace corral {
namespace {

constexpr double kStepPr = 0.1;  // rounding to such a step is noise of 0.03 pr
constexpr double kPowers[] = {10, 100, 1000};
constexpr double kLeastFactor = 1.7, kAlike = 1.08;

std::string three_digits(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

bool are_floats(const Points& points) {
  const double* numbers = points.data();
  return std::all_of(numbers, numbers + points.size(),
                     [](double number) { return static_cast<double>(static_cast<float>(number)) == number; });
}

/// Of 32-bit coordinates the step at the largest; 0 for others.
double float_step(const Points& points) {
  const double largest = points.cwiseAbs().maxCoeff();
  if (!(largest < std::numeric_limits<float>::max()) || !are_floats(points)) return 0;
  const auto number = static_cast<float>(largest);
  return static_cast<double>(std::nextafter(number, std::numeric_limits<float>::infinity()) - number);
}

bool is_near(double ratio, double power) { return ratio > 0.75 * power && ratio < 1.34 * power; }

bool is_power_of_ten(double extent_ratio, double resolution_ratio) {
  for (const double power : kPowers)
    for (const double factor : {power, 1 / power})
      if (is_near(resolution_ratio, factor) && extent_ratio > factor / 3 && extent_ratio < factor * 3) return true;
  return false;
}

bool is_same_factor(double extent_ratio, double resolution_ratio) {
  const double between = extent_ratio / resolution_ratio, factor = std::sqrt(extent_ratio * resolution_ratio);
  return between < kAlike && between > 1 / kAlike && std::max(factor, 1 / factor) > kLeastFactor;
}

bool is_told(NormalGuide guide) { return guide != NormalGuide::Origin; }

}  // namespace

std::string stray_warning(const PointSpacing& spacing) {
  if (!spacing.is_moved_by_strays()) return "";
  const std::size_t count = spacing.strays.size();
  const std::string which = count == 1 ? "stray point: vertex " + std::to_string(spacing.strays.front()) + " lies "
                                       : "stray points: vertex " + std::to_string(spacing.strays.front()) + " and " +
                                             std::to_string(count - 1) + " more lie up to ";
  return which + three_digits(spacing.stray_distance / spacing.median) + " times the median spacing from " +
         (count == 1 ? "all others" : "the rest") + "; pr is " + three_digits(spacing.resolution) + " with and " +
         three_digits(spacing.without_strays) + " without " + (count == 1 ? "it" : "them") +
         ": --drop-stray of 'match' and 'run' leaves " + (count == 1 ? "it" : "them") + " out, --resolution sets pr";
}

std::vector<std::string> surface_warnings(const Mesh& mesh, const PointSpacing& spacing) {
  std::vector<std::string> warnings;
  const std::string stray = stray_warning(spacing);
  if (!stray.empty()) warnings.push_back(stray);
  const double step = float_step(mesh.vertices);
  if (step >= kStepPr * spacing.without_strays)
    warnings.push_back("rounding: its coordinates, up to " + three_digits(mesh.vertices.cwiseAbs().maxCoeff()) +
                       ", are stored in 32 bits, in steps of " + three_digits(step) + " (" +
                       three_digits(step / spacing.without_strays) +
                       " pr): move the data to the origin before they are stored so");
  return warnings;
}

SurfaceSize size_of(const Points& vertices, double resolution) {
  const Points centred = vertices.rowwise() - vertices.colwise().mean();
  return {std::sqrt(centred.squaredNorm() / static_cast<double>(vertices.rows())), resolution};
}

std::string unit_warning(const SurfaceSize& source, const SurfaceSize& target) {
  const double extent_ratio = target.extent / source.extent, resolution_ratio = target.resolution / source.resolution;
  if (!is_power_of_ten(extent_ratio, resolution_ratio) && !is_same_factor(extent_ratio, resolution_ratio)) return "";
  return "units may differ: the target's pr is " + fixed(resolution_ratio, 3) + " times the source's, its extent " +
         fixed(extent_ratio, 3) + " times";
}

const char* to_text(NormalGuide guide) {
  switch (guide) {
    case NormalGuide::Faces:
      return "by the faces";
    case NormalGuide::Normals:
      return "by the normals of the file";
    case NormalGuide::NamedSensor:
      return "towards the sensor";
    case NormalGuide::OwnSensor:
      return "towards the sensor of the file";
    case NormalGuide::Origin:
      break;
  }
  return "towards the origin";
}

std::string normal_hint(NormalGuide source, NormalGuide target) {
  if (is_told(source) == is_told(target)) return "";
  const std::string lost = is_told(source) ? "target" : "source", told = is_told(source) ? "source" : "target";
  return "the normals of the " + lost + " point " + to_text(NormalGuide::Origin) +
         ", because its file does not say which side is outside, those of the " + told + " " +
         to_text(is_told(source) ? source : target) +
         ": if these are opposite sides, no match is correct; give the place of the sensor with --sensor x,y,z";
}

Mesh without_vertices(const Mesh& mesh, const Indices& dropped) {
  Indices number(static_cast<std::size_t>(mesh.vertices.rows()), 0), kept, faces;
  for (const int row : dropped) number[static_cast<std::size_t>(row)] = -1;
  for (std::size_t row = 0; row < number.size(); ++row)
    if (number[row] == 0) {
      number[row] = static_cast<int>(kept.size());
      kept.push_back(static_cast<int>(row));
    }
  const auto new_number = [&](int row) { return number[static_cast<std::size_t>(row)]; };
  for (int face = 0; face < mesh.triangles.rows(); ++face)
    if ((mesh.triangles.row(face).unaryExpr(new_number).array() >= 0).all()) faces.push_back(face);
  Mesh rest = mesh;
  rest.vertices = mesh.vertices(kept, Eigen::all);
  rest.triangles = mesh.triangles(faces, Eigen::all).unaryExpr(new_number);
  if (mesh.normals.rows() > 0) rest.normals = mesh.normals(kept, Eigen::all);
  return rest;
}

}  // namespace corral
