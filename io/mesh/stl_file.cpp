// SPDX-License-Identifier: MIT
// STL: triangles that each list their own corners, as text or packed after a header of 84 bytes. Corners at exactly the same
// place become one vertex: otherwise a mesh would have no connectivity.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <map>
#include <type_traits>

#include "io/mesh/mesh_cleanup.h"
#include "io/text/line_reader.h"
#include "io/text/stored_number.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

// The header of a binary file: 80 arbitrary bytes, then the number of facets. A facet: its normal and three corners in single
// precision, then two bytes without meaning.
constexpr std::size_t kTitle = 80, kHeader = 84, kFacet = 50;
constexpr NumberType kCount = {4, 'u'}, kCoordinate = {4, 'f'};

/// Makes vertices of the corners of facets, numbered as they first appear; `Number` is double, or float where the file has no
/// more digits. A corner is looked for in a table of hashes; where that is crowded, which only a file made for it can bring
/// about, in an ordered map: no file can cause quadratic time.
template <class Number>
class Welder {
 public:
  /// A closed surface has half as many vertices as facets.
  explicit Welder(std::size_t facets = 0) {
    vertices_.reserve(facets / 2 + 1024);
    std::size_t slots = 1024;
    while (slots < facets) slots *= 2;
    slots_.assign(slots, -1);
  }

  /// The vertex at a corner.
  int add(std::array<Number, 3> corner) {
    for (Number& coordinate : corner) coordinate += 0;  // -0 and +0 are one place: the sum is +0 for both
    if (2 * vertices_.size() >= slots_.size()) grow();
    Bits bits;
    std::memcpy(bits.data(), corner.data(), sizeof bits);
    return vertex_at(bits);
  }

  Points vertices() const {
    Points points(static_cast<Eigen::Index>(vertices_.size()), 3);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t vertex = 0; vertex < vertices_.size(); ++vertex) {
        Number coordinate;
        std::memcpy(&coordinate, &vertices_[vertex][axis], sizeof coordinate);
        points(static_cast<Eigen::Index>(vertex), static_cast<Eigen::Index>(axis)) = coordinate;
      }
    return points;
  }

 private:
  /// Compared bit by bit, a coordinate that is nan equals itself.
  using Word = std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint64_t>;
  using Bits = std::array<Word, 3>;

  static std::uint64_t hash_of(const Bits& bits) {
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;  // 2^64 by the golden ratio
    std::uint64_t hash = 0;
    for (const std::uint64_t word : bits) {
      hash = (hash ^ word) * kOdd;
      hash ^= hash >> 32;
    }
    return hash;
  }

  /// Without a branch for each word, or a call.
  static bool are_equal(const Bits& a, const Bits& b) { return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0; }

  int vertex_at(const Bits& bits) {
    constexpr std::size_t kProbes = 64;
    const std::size_t mask = slots_.size() - 1, first = hash_of(bits) & mask;
    for (std::size_t slot = first; slot < first + kProbes; ++slot) {
      int& vertex = slots_[slot & mask];
      if (vertex < 0) return vertex = append(bits);
      if (are_equal(vertices_[static_cast<std::size_t>(vertex)], bits)) return vertex;
    }
    const auto [place, is_new] = crowded_.try_emplace(bits, static_cast<int>(vertices_.size()));
    return is_new ? append(bits) : place->second;
  }

  int append(const Bits& bits) {
    vertices_.push_back(bits);
    return static_cast<int>(vertices_.size()) - 1;
  }

  void grow() {
    std::vector<Bits> vertices;
    vertices.swap(vertices_);
    vertices_.reserve(2 * vertices.size());
    slots_.assign(4 * slots_.size(), -1);
    crowded_.clear();
    for (const Bits& bits : vertices) vertex_at(bits);  // each is new: it gets its old number
  }

  std::vector<Bits> vertices_;
  std::vector<int> slots_;  // vertices by their hashes, a power of two many; -1 is free
  std::map<Bits, int> crowded_;
};

std::uint64_t binary_size(std::string_view content) {
  return kHeader + kFacet * static_cast<std::uint64_t>(decode_number(kCount, content.data() + kTitle));
}

/// Many writers begin the title of a binary file with the word solid too, so the size decides. A file that fits neither form
/// is treated as a damaged binary file if it contains a zero byte, which text does not, but for UTF-16.
bool is_binary(std::string_view content) {
  if (content.size() >= kHeader && content.size() == binary_size(content)) return true;
  return content.find('\0') != std::string_view::npos && !is_utf16(content);
}

StoredMesh parse_binary(const std::string& path, std::string_view content) {
  if (content.size() < kHeader)
    throw IoError(path, "byte " + std::to_string(content.size()),
                  "the file ends here, expected the " + std::to_string(kHeader) + " bytes of a binary header");
  const auto facets = static_cast<std::uint64_t>(decode_number(kCount, content.data() + kTitle));
  if (content.size() < binary_size(content))
    throw IoError(path, "byte " + std::to_string(kTitle),
                  "promises " + std::to_string(facets) + " facets, which take " + std::to_string(binary_size(content)) +
                      " bytes with the header, but the file has " + std::to_string(content.size()));
  if (3 * facets > static_cast<std::uint64_t>(kMaximumCount))
    throw IoError(path, "byte " + std::to_string(kTitle), "more facets than can be counted");
  Welder<float> welder(static_cast<std::size_t>(facets));
  StoredMesh mesh;
  mesh.triangles.resize(static_cast<Eigen::Index>(facets), 3);
  for (std::size_t facet = 0; facet < facets; ++facet) {
    const std::size_t start = kHeader + kFacet * facet + 12;  // behind the normal, which the corners give anyway
    std::array<double, 9> places;
    decode_numbers(kCoordinate, false, content.data() + start, 4, places.size(), places.data());
    for (std::size_t i = 0; i < places.size(); ++i)
      if (std::isinf(places[i]))
        throw IoError(path, "byte " + std::to_string(start + 4 * i),
                      "found " + to_text(places[i]) + " in facet " + std::to_string(facet) + " of " +
                          std::to_string(facets) + ", expected a finite coordinate");
    const auto place = [&](std::size_t i) { return static_cast<float>(places[i]); };
    for (std::size_t i = 0; i < 3; ++i)
      mesh.triangles(static_cast<Eigen::Index>(facet), static_cast<Eigen::Index>(i)) =
          welder.add({place(3 * i), place(3 * i + 1), place(3 * i + 2)});
  }
  mesh.vertices = welder.vertices();
  if (content.size() > binary_size(content))
    mesh.notes.push_back(unread_note(content.size() - binary_size(content), "facet"));
  return mesh;
}

/// Keywords may be written in either case.
bool is_word(std::string_view text, std::string_view lower_case) {
  const auto lower = [](char letter) { return letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter; };
  return std::equal(text.begin(), text.end(), lower_case.begin(), lower_case.end(),
                    [&](char a, char b) { return lower(a) == b; });
}

class TextReader {
 public:
  TextReader(const std::string& path, std::string_view content) : reader_(path, content) { reader_.allow_open_end(); }

  /// One solid after another; what follows the words solid and endsolid is a name.
  StoredMesh read() {
    bool lacks_end = false;
    reader_.need("the keyword solid");
    do {
      if (!is_word(reader_.fields()[0], "solid")) refuse("the keyword solid");
      while (true) {
        reader_.need("facet or endsolid");
        if (is_word(reader_.fields()[0], "endsolid")) break;
        read_facet();
      }
      lacks_end = reader_.lacks_end();
    } while (reader_.next());
    StoredMesh mesh;
    mesh.vertices = welder_.vertices();
    mesh.triangles = Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>>(
        corners_.data(), static_cast<Eigen::Index>(corners_.size() / 3), 3);
    if (lacks_end) mesh.notes.push_back(kOpenEndNote);
    return mesh;
  }

 private:
  void read_facet() {
    // The normal is ignored: some writers put no numbers there for a facet without area.
    if (!is_line({"facet", "normal"}, 3)) refuse("'facet normal NX NY NZ' or endsolid");
    if (corners_.size() + 3 > static_cast<std::size_t>(kMaximumCount)) reader_.fail("more facets than can be counted");
    need_line({"outer", "loop"});
    for (int corner = 0; corner < 3; ++corner) {
      reader_.need("'vertex X Y Z'");
      if (!is_line({"vertex"}, 3)) refuse("'vertex X Y Z'");
      const auto& fields = reader_.fields();
      corners_.push_back(
          welder_.add({reader_.coordinate(fields[1]), reader_.coordinate(fields[2]), reader_.coordinate(fields[3])}));
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
  Welder<double> welder_;
  Indices corners_;
};

}  // namespace

StoredMesh parse_stl(const std::string& path, std::string_view content) {
  return cleaned(is_binary(content) ? parse_binary(path, content) : TextReader(path, content).read());
}

}  // namespace corral
