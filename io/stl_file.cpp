// SPDX-License-Identifier: MIT
// STL: triangles that each list their own corners, as text or packed after a header of 84 bytes. Corners at exactly the same
// place become one vertex: otherwise a mesh would have no connectivity.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <tuple>

#include "io/line_reader.h"
#include "io/mesh_file.h"
#include "io/stored_number.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

// The header of a binary file: 80 arbitrary bytes, then the number of facets. A facet: its normal and three corners in single
// precision, then two bytes without meaning.
constexpr std::size_t kTitle = 80, kHeader = 84, kFacet = 50;
constexpr NumberType kCount = {4, 'u'}, kCoordinate = {4, 'f'};

/// The corners of all facets, three after three.
class FacetSoup {
 public:
  using Corner = std::array<double, 3>;

  void reserve(std::size_t facets) { corners_.reserve(3 * facets); }
  bool is_full() const { return corners_.size() + 3 > static_cast<std::size_t>(kMaximumCount); }
  void add(Corner corner) {
    for (double& coordinate : corner) coordinate += 0.0;  // -0 and +0 are one place: the sum is +0 for both
    corners_.push_back(corner);
  }

  /// Sorting rather than hashing, so that no file can cause quadratic time.
  StoredMesh weld() const {
    const auto corner = [&](int i) -> const Corner& { return corners_[static_cast<std::size_t>(i)]; };
    Indices order(corners_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::tie(corner(a), a) < std::tie(corner(b), b); });
    Indices first(corners_.size());  // the first corner at the same place
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool same = i > 0 && corner(order[i]) == corner(order[i - 1]);
      first[static_cast<std::size_t>(order[i])] = same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
    }
    return numbered(first);
  }

 private:
  /// Vertices are numbered in the order in which the file first names them.
  StoredMesh numbered(const Indices& first) const {
    StoredMesh mesh;
    int vertices = 0;
    for (std::size_t i = 0; i < first.size(); ++i) vertices += first[i] == static_cast<int>(i);
    mesh.vertices.resize(vertices, 3);
    mesh.triangles.resize(static_cast<Eigen::Index>(first.size() / 3), 3);
    Indices vertex_of(first.size());
    int next = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] == static_cast<int>(i)) {
        mesh.vertices.row(next) = Eigen::Map<const Eigen::RowVector3d>(corners_[i].data());
        vertex_of[i] = next++;
      }
      mesh.triangles(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) =
          vertex_of[static_cast<std::size_t>(first[i])];
    }
    return mesh;
  }

  std::vector<Corner> corners_;
};

std::uint64_t binary_size(std::string_view content) {
  return kHeader + kFacet * static_cast<std::uint64_t>(decode_number(kCount, content.data() + kTitle));
}

/// Many writers begin the title of a binary file with the word solid too, so the size decides. A file that fits neither form
/// is treated as a damaged binary file if it contains a zero byte, which text does not.
bool is_binary(std::string_view content) {
  if (content.size() >= kHeader && content.size() == binary_size(content)) return true;
  return content.find('\0') != std::string_view::npos;
}

StoredMesh parse_binary(const std::string& path, std::string_view content) {
  if (content.size() < kHeader)
    throw IoError(path, "byte " + std::to_string(content.size()),
                  "the file ends here, expected the " + std::to_string(kHeader) + " bytes of a binary header");
  const auto facets = static_cast<std::uint64_t>(decode_number(kCount, content.data() + kTitle));
  if (content.size() != binary_size(content))
    throw IoError(path, "byte " + std::to_string(kTitle),
                  "promises " + std::to_string(facets) + " facets, which take " + std::to_string(binary_size(content)) +
                      " bytes with the header, but the file has " + std::to_string(content.size()));
  if (3 * facets > static_cast<std::uint64_t>(kMaximumCount))
    throw IoError(path, "byte " + std::to_string(kTitle), "more facets than can be counted");
  FacetSoup soup;
  soup.reserve(static_cast<std::size_t>(facets));
  for (std::size_t facet = 0; facet < facets; ++facet) {
    const std::size_t start = kHeader + kFacet * facet;
    for (std::size_t corner = 1; corner <= 3; ++corner) {  // 0 is the normal, which the corners give anyway
      FacetSoup::Corner place;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = start + 12 * corner + 4 * axis;
        place[axis] = decode_number(kCoordinate, content.data() + at);
        if (!std::isfinite(place[axis]))
          throw IoError(path, "byte " + std::to_string(at),
                        "found " + to_text(place[axis]) + " in facet " + std::to_string(facet) + " of " +
                            std::to_string(facets) + ", expected a finite coordinate");
      }
      soup.add(place);
    }
  }
  return soup.weld();
}

/// Keywords may be written in either case.
bool is_word(std::string_view text, std::string_view lower_case) {
  const auto lower = [](char letter) { return letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter; };
  return std::equal(text.begin(), text.end(), lower_case.begin(), lower_case.end(),
                    [&](char a, char b) { return lower(a) == b; });
}

class TextReader {
 public:
  TextReader(const std::string& path, std::string_view content) : reader_(path, content) {}

  /// One solid after another; what follows the words solid and endsolid is a name.
  StoredMesh read() {
    reader_.need("the keyword solid");
    do {
      if (!is_word(reader_.fields()[0], "solid")) refuse("the keyword solid");
      while (true) {
        reader_.need("facet or endsolid");
        if (is_word(reader_.fields()[0], "endsolid")) break;
        read_facet();
      }
    } while (reader_.next());
    return soup_.weld();
  }

 private:
  void read_facet() {
    // The normal is ignored: some writers put no numbers there for a facet without area.
    if (!is_line({"facet", "normal"}, 3)) refuse("'facet normal NX NY NZ' or endsolid");
    if (soup_.is_full()) reader_.fail("more facets than can be counted");
    need_line({"outer", "loop"});
    for (int corner = 0; corner < 3; ++corner) {
      reader_.need("'vertex X Y Z'");
      if (!is_line({"vertex"}, 3)) refuse("'vertex X Y Z'");
      const auto& fields = reader_.fields();
      soup_.add({reader_.finite_number(fields[1]), reader_.finite_number(fields[2]), reader_.finite_number(fields[3])});
    }
    need_line({"endloop"});
    need_line({"endfacet"});
  }

  /// Whether the line holds these words, followed by `fields` more.
  bool is_line(std::initializer_list<std::string_view> words, std::size_t more) {
    const auto& fields = reader_.fields();
    return fields.size() == words.size() + more &&
           std::equal(words.begin(), words.end(), fields.begin(),
                      [](auto word, auto field) { return is_word(field, word); });
  }

  void need_line(std::initializer_list<std::string_view> words) {
    std::string wanted;
    for (const std::string_view word : words) wanted += (wanted.empty() ? "" : " ") + std::string(word);
    reader_.need("'" + wanted + "'");
    if (!is_line(words, 0)) refuse("'" + wanted + "'");
  }

  [[noreturn]] void refuse(const std::string& expected) {
    reader_.fail("found " + quoted(reader_.line()) + ", expected " + expected);
  }

  LineReader reader_;
  FacetSoup soup_;
};

}  // namespace

StoredMesh parse_stl(const std::string& path, std::string_view content) {
  return is_binary(content) ? parse_binary(path, content) : TextReader(path, content).read();
}

}  // namespace corral
