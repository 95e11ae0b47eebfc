// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/array/number_table.h"
#include "kernel/rigid_transform.h"

namespace corral {

/// Whether this names a whole .npz, not one of its arrays.
bool is_archive(const std::string& name);

/// The arrays of a .npz by what they are: they are known by the names that programs of the field give them (io/README.md).
class NamedArrays {
 public:
  /// Throws IoError if it is no such file.
  explicit NamedArrays(const std::string& path);

  struct Pair {
    std::string source, target;  ///< empty where there are none
  };
  Pair points() const;
  Pair features() const;        ///< of the points, to be matched
  std::string matches() const;  ///< a table; empty if there is none, as below
  std::string labels() const;
  std::optional<RigidTransform> pose();  ///< target_from_source

  /// One side alone: its points, its features.
  std::string own_points() const;
  std::string own_features() const;

  NumberTable read(const std::string& name);
  std::string unread() const;  ///< the names of the others, in one line

 private:
  bool has(const std::string& name) const;
  std::string first_of(const std::vector<const char*>& names) const;
  Pair first_of(const std::vector<std::pair<const char*, const char*>>& pairs) const;

  std::string path_, content_;
  std::vector<std::string> names_, read_;
};

}  // namespace corral
