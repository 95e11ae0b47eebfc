// SPDX-License-Identifier: MIT
#pragma once

// PCD files for tests, in both encodings from one description.

#include <string>
#include <vector>

#include "tests/io/mesh/ply_encoder.h"

namespace corral::testing {

/// The entries of a header that come before DATA.
struct PcdEntries {
  std::string version = "0.7";
  std::string fields = "x y z", sizes = "4 4 4", types = "F F F", counts = "1 1 1";
  std::string width = "4", height = "1", points = "4";

  std::string text() const {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION " + version + "\nFIELDS " + fields + "\nSIZE " + sizes +
           "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " + width + "\nHEIGHT " + height +
           "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\n";
  }
};

inline std::string pcd_file(bool binary, const std::string& entries, const std::vector<PlyRow>& rows) {
  return entries + "DATA " + (binary ? "binary\n" : "ascii\n") +
         ply_body(binary ? "binary_little_endian" : "ascii", rows);
}

/// Four points of single precision.
inline std::string square_pcd(bool binary, const PcdEntries& entries = {}) {
  return pcd_file(binary, entries.text(),
                  {{{'f', 0}, {'f', 0}, {'f', 0.5}},
                   {{'f', 1}, {'f', 0}, {'f', 0.5}},
                   {{'f', 1}, {'f', 1}, {'f', 0.5}},
                   {{'f', 0}, {'f', 1}, {'f', 0.5}}});
}

/// Fields in any order and of any type, gaps, a field of several values, a grid of 2 x 2 points.
inline std::string intricate_pcd(bool binary) {
  PcdEntries entries;
  entries.fields = "rgb z _ x bins y _";
  entries.sizes = "4 8 1 4 2 2 1";
  entries.types = "U F U F I I U";
  entries.counts = "1 1 2 1 3 1 1";
  entries.width = entries.height = "2";
  const auto row = [](double rgb, double z, double x, double bin, double y) -> PlyRow {
    return {{'I', rgb}, {'d', z},   {'B', 0},   {'B', 255}, {'f', x},
            {'h', bin}, {'h', bin}, {'h', -17}, {'h', y},   {'B', 1}};
  };
  return pcd_file(binary, entries.text(),
                  {row(4294967295.0, 0.1, 1.5, -32768, -300), row(0, 0.2, 2.5, 32767, 300), row(1, -0.3, 3.5, 0, 32767),
                   row(2, 1e300, 4.5, 1, -32768)});
}

}  // namespace corral::testing
