// SPDX-License-Identifier: MIT
#include "io/mesh/ply_header.h"
#include "kernel/number_text.h"

#include <array>

#include "io/mesh/mesh_file.h"

namespace corral {
namespace {

constexpr std::array<PlyType, 8> kTypes = {{{{1, 'i'}, "char", "int8"},
                                            {{1, 'u'}, "uchar", "uint8"},
                                            {{2, 'i'}, "short", "int16"},
                                            {{2, 'u'}, "ushort", "uint16"},
                                            {{4, 'i'}, "int", "int32"},
                                            {{4, 'u'}, "uint", "uint32"},
                                            {{4, 'f'}, "float", "float32"},
                                            {{8, 'f'}, "double", "float64"}}};

const PlyType* find_type(const LineReader& reader, std::string_view name) {
  for (const PlyType& type : kTypes)
    if (name == type.name || name == type.other_name) return &type;
  reader.fail("found the type " + quoted(name) + ", expected char, uchar, short, ushort, int, uint, float or double");
}

PlyProperty parse_property(const LineReader& reader, const std::vector<std::string_view>& fields) {
  if (fields.size() == 3) return {std::string(fields[2]), find_type(reader, fields[1]), nullptr};
  if (fields.size() != 5 || fields[1] != "list")
    reader.fail("found " + quoted(reader.line()) + ", expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  const PlyType* count_type = find_type(reader, fields[2]);
  if (count_type->kind == 'f')
    reader.fail("the length of a list is of type " + quoted(fields[2]) + ", expected an integer type");
  return {std::string(fields[4]), find_type(reader, fields[3]), count_type};
}

PlyEncoding parse_format(const LineReader& reader, const std::vector<std::string_view>& fields) {
  if (fields.size() == 3 && fields[0] == "format" && fields[2] == "1.0") {
    if (fields[1] == "ascii") return PlyEncoding::Ascii;
    if (fields[1] == "binary_little_endian") return PlyEncoding::Little;
    if (fields[1] == "binary_big_endian") return PlyEncoding::Big;
  }
  reader.fail("found " + quoted(reader.line()) +
              ", expected 'format ascii|binary_little_endian|binary_big_endian 1.0'");
}

/// obj_info is free text; two of its lines say how wide and high a range grid is.
void read_remark(LineReader& reader, PlyHeader& header) {
  const auto& fields = reader.fields();
  if (fields.size() != 3 || fields[0] != "obj_info") return;
  std::int64_t* const size = fields[1] == "num_cols"   ? &header.grid_columns
                             : fields[1] == "num_rows" ? &header.grid_rows
                                                       : nullptr;
  if (size != nullptr) *size = parse_int(fields[2]).value_or(0);
}

constexpr std::size_t kMostDeclared = 1000;  // each name is compared with the others

bool is_remark(std::string_view keyword) { return keyword == "comment" || keyword == "obj_info"; }

}  // namespace

PlyHeader parse_ply_header(LineReader& reader) {
  PlyHeader header;
  reader.need("the word ply");
  if (reader.line() != "ply") reader.fail("found " + quoted(reader.line()) + ", expected the word ply");
  for (reader.need("the format"); is_remark(reader.fields()[0]); reader.need("the format")) read_remark(reader, header);
  header.encoding = parse_format(reader, reader.fields());
  while (true) {
    reader.need("end_header");
    const auto& fields = reader.fields();
    if (fields[0] == "end_header") return header;
    if (is_remark(fields[0])) {
      read_remark(reader, header);
      continue;
    }
    std::size_t declared = 0;
    for (const PlyElement& each : header.elements) declared += 1 + each.properties.size();
    if (declared >= kMostDeclared) reader.fail("more than 1000 elements and properties");
    if (fields[0] == "element" && fields.size() == 3) {
      for (const PlyElement& other : header.elements)
        if (other.name == fields[1]) reader.fail("element " + quoted(fields[1]) + " occurs twice");
      header.elements.push_back(
          {std::string(fields[1]), reader.integer(fields[2], 0, kMaximumCount, "the number of elements"), {}});
    } else if (fields[0] == "property" && !header.elements.empty()) {
      const PlyProperty property = parse_property(reader, fields);
      if (header.elements.back().find(property.name) >= 0)
        reader.fail("property " + quoted(property.name) + " occurs twice");
      header.elements.back().properties.push_back(property);
    } else {
      reader.fail("found " + quoted(reader.line()) + ", expected an element or a property");
    }
  }
}

}  // namespace corral
