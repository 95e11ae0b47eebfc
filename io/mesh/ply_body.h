// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/mesh/ply_header.h"

namespace corral {

/// A scalar property that is read into a column, one number per element.
struct PlyColumn {
  int property = -1;
  double* numbers = nullptr;
  bool is_coordinate = false;  ///< then it must not be infinite
};

/// What is taken of an element; all else is checked and skipped.
struct PlyWanted {
  std::vector<PlyColumn> columns = {};
  int list = -1;                                                               ///< a property that lists whole numbers
  std::function<void(const std::vector<std::int64_t>& values)> use_list = {};  ///< called for it in every element
};

/// What follows the header, in one of the encodings. Errors are IoError with the line or byte.
class PlyBody {
 public:
  virtual ~PlyBody() = default;

  virtual std::size_t bytes_left() const = 0;
  /// The fewest bytes that an element can take.
  virtual std::size_t smallest(const PlyElement& element) const = 0;
  /// Reads all elements of this name.
  virtual void read(const PlyElement& element, const PlyWanted& wanted) = 0;
  /// Notes what follows the last element, if anything does, or how that ends.
  virtual void note_end(std::vector<std::string>& notes) = 0;
  /// At the place of what was read last.
  [[noreturn]] virtual void fail(const std::string& problem) const = 0;
};

/// One element per line.
std::unique_ptr<PlyBody> ply_text_body(LineReader& reader);
/// Packed bytes.
std::unique_ptr<PlyBody> ply_binary_body(const std::string& path, std::string_view bytes, bool big_endian);

}  // namespace corral
