// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace corral {

/// An array of numpy as a table.
struct StoredArray {
  Eigen::MatrixXd rows;            ///< column i is row i of the array
  std::vector<std::size_t> shape;  ///< as in the file
  bool is_whole = false;           ///< of whole numbers or truth values
};

/// Reads an array in numpy's format, as its documentation describes it: version 1 to 3; numbers of 1, 2, 4 or 8 bytes, signed,
/// unsigned or floating point (not of 2 bytes), and truth values; either byte order; row by row or column by column. Axes of
/// length 1 in front of the last two are dropped; a list is a table with one number in a row, a single number one row.
/// `path` is used in messages.
/// Throws    IoError naming file and byte: not this format, cut short, another type, more than two axes, more numbers than
///           bytes, which is found before anything is allocated.
StoredArray parse_npy(const std::string& path, std::string_view content);

/// The names of the arrays in a file .npz, in its order, without .npy behind.
std::vector<std::string> npz_names(const std::string& path, std::string_view content);

/// One of them. A file .npz is a zip archive, stored or deflated; its sizes are checked against the bytes of the file before
/// anything is allocated, and its checksum against the content.
/// Throws    IoError naming file and byte, or the names that there are.
StoredArray parse_npz(const std::string& path, std::string_view content, const std::string& name);

}  // namespace corral
