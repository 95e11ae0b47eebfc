// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace corral {

/// Rows of numbers in a file of another program.
struct NumberTable {
  std::string path;                ///< as it was named
  Eigen::MatrixXd rows;            ///< column i is row i of the file; nan and inf may be there
  std::vector<std::string> names;  ///< of the numbers in a row, in small letters; empty where the file has none
  std::vector<int> lines;          ///< of text: the line of each row
  std::vector<std::string> notes;  ///< what a user should know: a sentence each, no full stop

  int size() const { return static_cast<int>(rows.cols()); }
  int width() const { return static_cast<int>(rows.rows()); }
  std::string place(int row) const;  ///< "line 3" or "row 2", for messages
  [[noreturn]] void fail(int row, const std::string& problem) const;
};

/// An array that a file holds: FILE, or FILE:NAME for one of a .npz.
struct ArrayName {
  std::string file, name;
};
ArrayName split_array_name(const std::string& text);

/// Reads FILE.npy, FILE.npz:NAME, or text: a row per line, separated by white space, commas or semicolons; lines that begin
/// with # are comments; the first line may have names instead of numbers. A last line without its end is read, and noted.
/// Throws    IoError naming file and line or byte: no row, ragged rows, a field that is not a number.
NumberTable read_number_table(const std::string& name);

/// The same with rows and columns exchanged, if it has `width` rows of another length than `width`: how MATLAB and Eigen print
/// a list of points, and noted. Unchanged if its rows have at least `width` numbers otherwise.
/// Throws    IoError where neither has.
NumberTable with_width(NumberTable table, int width, const std::string& what);

}  // namespace corral
