// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace corral {

/// A table of a TOML file, read key by key. Every error is an IoError that names file, line and key.
class TomlTable {
 public:
  /// Reads a file; throws IoError if it is not TOML.
  static TomlTable read(const std::string& path);
  /// The same for text in memory; `path` is used in messages.
  static TomlTable parse(const std::string& path, const std::string& text);

  // The value of a key, absent if the key is. A value of another type is an IoError.
  std::optional<std::string> text(const std::string& key) const;
  std::optional<double> number(const std::string& key) const;  ///< finite; whole numbers too
  std::optional<std::int64_t> integer(const std::string& key) const;
  std::optional<bool> flag(const std::string& key) const;
  std::vector<std::string> texts(const std::string& key) const;                 ///< of a list; empty if absent
  std::vector<double> numbers(const std::string& key) const;                    ///< of a list; empty if absent
  std::vector<std::vector<double>> number_lists(const std::string& key) const;  ///< of a list of lists
  std::optional<TomlTable> table(const std::string& key) const;                 ///< [key]
  std::vector<TomlTable> tables(const std::string& key) const;                  ///< [[key]]
  /// A text, number or flag as text, as "key=value" options want it.
  std::optional<std::string> scalar_text(const std::string& key) const;

  std::vector<std::string> keys() const;  ///< sorted by name
  bool has(const std::string& key) const;

  /// Throws IoError if the table has an unknown key, and suggests the known key most like it.
  void only(const std::vector<std::string>& known) const;

  /// Throws IoError at the line of the key, or of the table if it is not there.
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;

 private:
  struct State;
  explicit TomlTable(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  std::shared_ptr<const State> state_;
};

/// Text as a quoted TOML string.
std::string toml_text(const std::string& value);

/// The name with the smallest edit distance to this one, the first of several; empty if none is similar (more than a third
/// of the letters differ).
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

}  // namespace corral
