// SPDX-License-Identifier: MIT
// OBJ: lines of vertices (v), normals (vn) and faces (f) among others; what a face names counts from 1, or backwards from -1.
#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "io/mesh/mesh_cleanup.h"
#include "io/text/line_reader.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

using Named = std::pair<int, int>;  // a vertex, and a normal that a face names for it

/// Statements that belong to meshes of polygons and are not read: texture, groups, materials, display.
bool is_known(std::string_view keyword) {
  constexpr std::array<std::string_view, 17> kKnown = {
      "vt",     "g",      "o",   "s",     "usemtl",   "mtllib",   "l",          "p",        "mg",
      "usemap", "maplib", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"};
  return std::find(kKnown.begin(), kKnown.end(), keyword) != kKnown.end();
}

class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view content) : reader_(path, content, '#') {
    reader_.allow_comments_behind();
    reader_.allow_continuations();
  }

  StoredMesh read() {
    while (reader_.next()) {
      const std::string_view keyword = reader_.take();
      if (keyword == "v")
        read_numbers(vertices_, "coordinates");
      else if (keyword == "vn")
        read_numbers(normals_, "components of a normal");
      else if (keyword == "f")
        read_face();
      else if (!is_known(keyword))
        skip(keyword);
    }
    if (vertices_.empty()) reader_.fail("no vertex line, expected lines like 'v 0 0 0'");
    StoredMesh mesh;
    mesh.vertices = points_of_rows(vertices_);
    mesh.triangles = triangles_.build();
    mesh.normals = normals_of_vertices();
    add_notes(mesh.notes);
    return cleaned(std::move(mesh));
  }

 private:
  std::int64_t vertices() const { return static_cast<std::int64_t>(vertices_.size() / 3); }
  std::int64_t normals() const { return static_cast<std::int64_t>(normals_.size() / 3); }

  void read_numbers(std::vector<double>& numbers, const char* what) {
    if (static_cast<std::int64_t>(numbers.size() / 3) == kMaximumCount)
      reader_.fail("more vertices than can be counted");
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view field = reader_.take();
      if (field.empty()) reader_.fail("found " + std::to_string(axis) + " fields, expected three " + what);
      numbers.push_back(&numbers == &vertices_ ? reader_.coordinate(field) : reader_.number(field));
    }
  }

  void read_face() {
    corners_.clear();
    for (std::string_view field = reader_.take(); !field.empty(); field = reader_.take()) {
      corners_.push_back(corner_of(field));
      if (const std::size_t slash = field.find('/'); slash != std::string_view::npos)
        name_normal(static_cast<int>(corners_.back()), field.substr(slash + 1));
    }
    if (corners_.size() < 3)
      reader_.fail("found " + std::to_string(corners_.size()) + " corners, expected at least three");
    triangles_.add_polygon(corners_);
  }

  std::int64_t corner_of(std::string_view field) const {
    const std::string_view index = field.substr(0, field.find('/'));
    const bool backwards = index.substr(0, 1) == "-";
    const std::int64_t low = backwards ? -vertices() : 1, high = backwards ? -1 : vertices();
    const std::int64_t corner = reader_.integer(index, low, high, "a corner");
    return corner > 0 ? corner - 1 : vertices() + corner;
  }

  /// `names` is TEXTURE/NORMAL, each of which may be absent. A normal that is not there is counted: the mesh needs none.
  void name_normal(int vertex, std::string_view names) {
    const std::size_t slash = names.find('/');
    if (slash == std::string_view::npos || slash + 1 == names.size()) return;
    const auto index = parse_int(names.substr(slash + 1)).value_or(0);
    const std::int64_t normal = index > 0 ? index - 1 : normals() + index;
    if (index == 0 || normal < 0 || normal >= normals()) {
      ++absent_normals_;
      return;
    }
    const Named named = {vertex, static_cast<int>(normal)};
    if (named_.empty() || named_.back() != named) named_.push_back(named);
  }

  /// For each vertex the normal that its faces name; of several, each counted once, the direction of the sum of unit normals.
  Points normals_of_vertices() {
    if (named_.empty())  // a cloud whose points each have a normal line
      return triangles_.empty() && normals() == vertices() ? points_of_rows(normals_) : Points(0, 3);
    std::sort(named_.begin(), named_.end());
    named_.erase(std::unique(named_.begin(), named_.end()), named_.end());
    Points sums = Points::Zero(vertices(), 3);
    for (auto first = named_.begin(); first != named_.end();) {
      const auto last =
          std::find_if(first, named_.end(), [&](const Named& named) { return named.first != first->first; });
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (auto named = first; named != last; ++named) {
        const Eigen::RowVector3d normal =
            Eigen::Map<const Eigen::RowVector3d>(&normals_[3 * static_cast<std::size_t>(named->second)]);
        if (last - first == 1 || normal.allFinite()) sum += last - first == 1 ? normal : normal.stableNormalized();
      }
      constexpr double kOpposed = 1e-6;  // what rounding leaves of normals that point against each other
      if (last - first > 1) sum = sum.norm() > kOpposed ? sum.normalized() : Eigen::RowVector3d::Zero();
      sums.row(first->first) = sum;
      first = last;
    }
    return sums;
  }

  void skip(std::string_view keyword) {
    ++skipped_;
    constexpr std::size_t kNamed = 8;
    if (skipped_names_.size() < kNamed) skipped_names_.insert(quoted(keyword));
  }

  void add_notes(std::vector<std::string>& notes) const {
    if (skipped_ > 0) {
      std::string names;
      for (const std::string& name : skipped_names_) names += (names.empty() ? "" : ", ") + name;
      notes.push_back(counted(skipped_, "statement", "statements") + " that are not supported " +
                      (skipped_ == 1 ? "was" : "were") + " skipped: " + names);
    }
    if (absent_normals_ > 0)
      notes.push_back(counted(absent_normals_, "corner names a normal", "corners name normals") +
                      " that the file does not have");
  }

  LineReader reader_;
  std::vector<double> vertices_, normals_;
  TriangleBuilder triangles_;
  std::vector<std::int64_t> corners_;
  std::vector<Named> named_;
  std::int64_t skipped_ = 0, absent_normals_ = 0;
  std::set<std::string> skipped_names_;
};

}  // namespace

StoredMesh parse_obj(const std::string& path, std::string_view content) { return ObjReader(path, content).read(); }

}  // namespace corral
