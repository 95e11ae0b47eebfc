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

  using Corner = std::array<Number, 3>;

  /// The vertex at a corner.
  int add(const Corner& corner) {
    if (2 * vertices_.size() >= slots_.size()) grow();
    return vertex_at(bits_of(corner));
  }

  /// The vertices at several corners. Most are there already; their slots, far apart in memory, and then their places are
  /// read without waiting for one another.
  template <std::size_t N>
  void add(const std::array<Corner, N>& corners, std::size_t count, std::array<int, N>& vertices) {
    if (2 * (vertices_.size() + count) >= slots_.size()) grow();
    std::array<Bits, N> bits;
    for (std::size_t i = 0; i < count; ++i) bits[i] = bits_of(corners[i]);
    for (std::size_t i = 0; i < count; ++i) vertices[i] = slots_[hash_of(bits[i]) & (slots_.size() - 1)];
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_there = vertices[i] >= 0 && are_equal(vertices_[static_cast<std::size_t>(vertices[i])], bits[i]);
      if (!is_there) vertices[i] = -1;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (vertices[i] < 0) vertices[i] = vertex_at(bits[i]);
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

  static Bits bits_of(Corner corner) {
    for (Number& coordinate : corner) coordinate += 0;  // -0 and +0 are one place: the sum is +0 for both
    Bits bits;
    std::memcpy(bits.data(), corner.data(), sizeof bits);
    return bits;
  }

  /// The sums of products do not wait for each other.
  static std::uint64_t hash_of(const Bits& bits) {
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;  // 2^64 by the golden ratio
    const std::uint64_t sum = bits[0] * kOdd + bits[1] * 0xbf58476d1ce4e5b9 + bits[2] * 0x94d049bb133111eb;
    return (sum ^ sum >> 32) * kOdd >> 32;
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
  constexpr std::size_t kBlock = 512;  // facets
  Welder<float> welder(static_cast<std::size_t>(facets));
  StoredMesh mesh;
  mesh.triangles.resize(static_cast<Eigen::Index>(facets), 3);
  std::array<Welder<float>::Corner, 3 * kBlock> corners;
  std::array<int, 3 * kBlock> vertices;
  for (std::size_t facet = 0; facet < facets;) {
    const std::size_t first = facet;
    for (std::size_t corner = 0; facet < std::min<std::size_t>(facets, first + kBlock); ++facet) {
      const std::size_t start = kHeader + kFacet * facet + 12;  // behind the normal, which the corners give anyway
      std::array<double, 9> places;
      decode_numbers(kCoordinate, false, content.data() + start, 4, places.size(), places.data());
      for (std::size_t i = 0; i < places.size(); ++i)
        if (std::isinf(places[i]))
          throw IoError(path, "byte " + std::to_string(start + 4 * i),
                        "found " + to_text(places[i]) + " in facet " + std::to_string(facet) + " of " +
                            std::to_string(facets) + ", expected a finite coordinate");
      const auto place = [&](std::size_t i) { return static_cast<float>(places[i]); };
      for (std::size_t i = 0; i < 9; i += 3) corners[corner++] = {place(i), place(i + 1), place(i + 2)};
    }
    welder.add(corners, 3 * (facet - first), vertices);
    for (std::size_t i = first, corner = 0; i < facet; ++i)
      for (Eigen::Index column = 0; column < 3; ++column)
        mesh.triangles(static_cast<Eigen::Index>(i), column) = vertices[corner++];
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
      if (!is_word(first_word(), "solid")) refuse("the keyword solid");
      while (true) {
        reader_.need("facet or endsolid");
        if (is_word(first_word(), "endsolid")) break;
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
  std::string_view first_word() {
    const std::string_view word = reader_.take();
    reader_.skip_letters(0);
    return word;
  }

  void read_facet() {
    // The normal is ignored: some writers put no numbers there for a facet without area.
    if (!is_facet()) refuse("'facet normal NX NY NZ' or endsolid");
    if (corners_.size() + 3 > static_cast<std::size_t>(kMaximumCount)) reader_.fail("more facets than can be counted");
    need_line("outer loop");
    for (int corner = 0; corner < 3; ++corner) {
      reader_.need("'vertex X Y Z'");
      const bool is_vertex = is_word(reader_.take(), "vertex");
      const std::array<std::string_view, 3> place = {reader_.take(), reader_.take(), reader_.take()};
      if (!is_vertex || place[2].empty() || !reader_.take().empty()) refuse("'vertex X Y Z'");
      corners_.push_back(
          welder_.add({reader_.coordinate(place[0]), reader_.coordinate(place[1]), reader_.coordinate(place[2])}));
    }
    need_line("endloop");
    need_line("endfacet");
  }

  /// Whether the line is 'facet normal' and three more words.
  bool is_facet() {
    bool is = is_word(reader_.take(), "facet") && is_word(reader_.take(), "normal");
    for (int i = 0; i < 3; ++i) is = is && !reader_.take().empty();
    return is && reader_.take().empty();
  }

  /// The next line must hold these words: nearly always as they stand here.
  void need_line(const char* words) {
    if (reader_.next() && reader_.line() == words) return;
    const std::string wanted = "'" + std::string(words) + "'";
    if (reader_.line().empty()) reader_.fail_at_end(wanted);
    std::string found;
    for (const std::string_view field : reader_.fields()) (found += found.empty() ? "" : " ") += field;
    if (!is_word(found, words)) refuse(wanted);
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
