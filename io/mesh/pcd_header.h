// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/text/stored_number.h"

namespace corral {

struct PcdField {
  std::string name;
  NumberType type{4, 'f'};
  std::string type_name;   ///< "F4"
  std::int64_t count = 1;  ///< values of it in each point
  int axis = -1;           ///< 0, 1, 2 for x, y, z; 3, 4, 5 for those of the normal
};

enum class PcdEncoding { Ascii, Binary, Compressed };

struct PcdHeader {
  std::vector<PcdField> fields;  ///< x, y and z are among them, once each
  std::int64_t points = 0;
  PcdEncoding encoding = PcdEncoding::Ascii;
  std::optional<Eigen::Vector3d> sensor = {};  ///< of VIEWPOINT, unless that is the default pose

  bool has_normals() const;  ///< all three components
  std::size_t values_per_point() const;
  std::size_t bytes_per_point() const;
};

/// Reads up to and including the line DATA. Throws IoError.
PcdHeader parse_pcd_header(LineReader& reader);

}  // namespace corral
