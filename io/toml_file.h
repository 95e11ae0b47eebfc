// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace corral {

/// A table of a TOML file, read key by key. Everything wrong becomes an IoError that names file, line and key.
class TomlTable {
 public:
  /// Reads a file; throws IoError if it is no TOML.
  static TomlTable read(const std::string& path);
  /// The same of text that is in memory; `path` is for the messages.
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

  std::vector<std::string> keys() const;  ///< in the order of their names

  /// Throws IoError if the table has a key that is none of these, with the nearest of them.
  void only(const std::vector<std::string>& known) const;

  /// Throws IoError at the line of the key, or of the table if it is not there.
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;

 private:
  struct State;
  explicit TomlTable(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  std::shared_ptr<const State> state_;
};

/// Text as a TOML string with its quotes.
std::string toml_text(const std::string& value);

/// The one of the names that is written most like this one: fewest letters to change, insert or leave out, the first of
/// several; empty if none is near (more than a third of the letters differ).
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

}  // namespace corral
