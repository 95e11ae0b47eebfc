// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/text/line_reader.h"
#include "io/text/stored_number.h"

namespace corral {

struct PlyType : NumberType {
  std::string_view name, other_name;  ///< "int", "int32"
};
struct PlyProperty {
  std::string name;
  const PlyType* type = nullptr;
  const PlyType* count_type = nullptr;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Position of a property among the others, -1 if there is none.
  int find(std::string_view wanted) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      if (properties[i].name == wanted) return static_cast<int>(i);
    return -1;
  }
};

enum class PlyEncoding { Ascii, Little, Big };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Ascii;
  std::vector<PlyElement> elements;
  std::int64_t grid_columns = 0, grid_rows = 0;  ///< of obj_info num_cols and num_rows, which Stanford's scans have
};

/// Reads up to and including the line end_header. Throws IoError.
PlyHeader parse_ply_header(LineReader& reader);

}  // namespace corral
