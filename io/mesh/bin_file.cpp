// SPDX-License-Identifier: MIT
#include "io/mesh/bin_file.h"

#include <cmath>

#include "io/mesh/mesh_cleanup.h"
#include "io/text/stored_number.h"
#include "kernel/error.h"

namespace corral {

StoredMesh parse_bin(const std::string& path, std::string_view content) {
  constexpr std::size_t kPoint = 16;
  if (content.size() % kPoint != 0)
    throw IoError(path, "byte " + std::to_string(content.size()),
                  "the file ends within a point, expected 16 bytes for each (x, y, z, reflectance)");
  const std::size_t points = content.size() / kPoint;
  if (points > static_cast<std::size_t>(kMaximumCount))
    throw IoError(path, "",
                  "has " + std::to_string(points) + " points, expected at most " + std::to_string(kMaximumCount));
  StoredMesh cloud;
  cloud.vertices.resize(static_cast<Eigen::Index>(points), 3);
  std::vector<double> axis(points);
  for (int i = 0; i < 3; ++i) {
    decode_numbers({4, 'f'}, false, content.data() + 4 * i, kPoint, points, axis.data());
    for (std::size_t point = 0; point < points; ++point)
      if (std::isinf(axis[point]))
        throw IoError(path, "byte " + std::to_string(kPoint * point + 4 * std::size_t(i)),
                      "a coordinate is infinite, expected a finite number");
    cloud.vertices.col(i) = Eigen::Map<const Eigen::VectorXd>(axis.data(), static_cast<Eigen::Index>(points));
  }
  return cleaned(std::move(cloud));
}

}  // namespace corral
