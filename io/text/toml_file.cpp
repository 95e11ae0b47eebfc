// SPDX-License-Identifier: MIT
#include "io/text/toml_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "io/disk/file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

struct TomlTable::State {
  std::string path;
  std::shared_ptr<const toml::table> root;  // owns `table`
  const toml::table* table;

  const toml::node* find(const std::string& key) const { return table->get(key); }
};

namespace {

std::string line_of(const toml::node& node) { return "line " + std::to_string(node.source().begin.line); }

[[noreturn]] void fail_at(const std::string& path, const toml::node& node, const std::string& problem) {
  throw IoError(path, line_of(node), problem);
}

double finite_value(const std::string& path, const std::string& key, const toml::node& node) {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) fail_at(path, node, key + ": expected a finite number");
  return *value;
}

std::vector<double> number_list(const std::string& path, const std::string& key, const toml::node& node) {
  if (!node.is_array()) fail_at(path, node, key + ": expected a list of numbers");
  std::vector<double> numbers;
  for (const toml::node& item : *node.as_array()) numbers.push_back(finite_value(path, key, item));
  return numbers;
}

}  // namespace

TomlTable TomlTable::read(const std::string& path) { return parse(path, read_file(path)); }

TomlTable TomlTable::parse(const std::string& path, const std::string& text) {
  try {
    const auto root = std::make_shared<const toml::table>(toml::parse(text, path));
    return TomlTable(std::make_shared<const State>(State{path, root, root.get()}));
  } catch (const toml::parse_error& error) {
    throw IoError(path, "line " + std::to_string(error.source().begin.line),
                  "no TOML: " + std::string(error.description()));
  }
}

std::optional<std::string> TomlTable::text(const std::string& key) const {
  const toml::node* node = state_->find(key);
  if (!node) return std::nullopt;
  if (!node->is_string()) fail(key, "expected text in quotes");
  return node->value<std::string>();
}

std::optional<double> TomlTable::number(const std::string& key) const {
  const toml::node* node = state_->find(key);
  if (!node) return std::nullopt;
  return finite_value(state_->path, key, *node);
}

std::optional<std::int64_t> TomlTable::integer(const std::string& key) const {
  const toml::node* node = state_->find(key);
  if (!node) return std::nullopt;
  if (!node->is_integer()) fail(key, "expected a whole number");
  return node->value<std::int64_t>();
}

std::optional<bool> TomlTable::flag(const std::string& key) const {
  const toml::node* node = state_->find(key);
  if (!node) return std::nullopt;
  if (!node->is_boolean()) fail(key, "expected true or false");
  return node->value<bool>();
}

std::vector<std::string> TomlTable::texts(const std::string& key) const {
  std::vector<std::string> texts;
  const toml::node* node = state_->find(key);
  if (!node) return texts;
  if (!node->is_array()) fail(key, "expected a list of texts");
  for (const toml::node& item : *node->as_array()) {
    if (!item.is_string()) fail_at(state_->path, item, key + ": expected text in quotes");
    texts.push_back(*item.value<std::string>());
  }
  return texts;
}

std::vector<double> TomlTable::numbers(const std::string& key) const {
  const toml::node* node = state_->find(key);
  return node ? number_list(state_->path, key, *node) : std::vector<double>();
}

std::vector<std::vector<double>> TomlTable::number_lists(const std::string& key) const {
  std::vector<std::vector<double>> lists;
  const toml::node* node = state_->find(key);
  if (!node) return lists;
  if (!node->is_array()) fail(key, "expected a list of lists of numbers");
  for (const toml::node& item : *node->as_array()) lists.push_back(number_list(state_->path, key, item));
  return lists;
}

std::optional<TomlTable> TomlTable::table(const std::string& key) const {
  const toml::node* node = state_->find(key);
  if (!node) return std::nullopt;
  if (!node->is_table()) fail(key, "expected a table [" + key + "]");
  return TomlTable(std::make_shared<const State>(State{state_->path, state_->root, node->as_table()}));
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) const {
  std::vector<TomlTable> tables;
  const toml::node* node = state_->find(key);
  if (!node) return tables;
  if (!node->is_array()) fail(key, "expected tables [[" + key + "]]");
  for (const toml::node& item : *node->as_array()) {
    if (!item.is_table()) fail_at(state_->path, item, "expected a table [[" + key + "]]");
    tables.push_back(TomlTable(std::make_shared<const State>(State{state_->path, state_->root, item.as_table()})));
  }
  return tables;
}

std::optional<std::string> TomlTable::scalar_text(const std::string& key) const {
  const toml::node* node = state_->find(key);
  if (!node) return std::nullopt;
  if (node->is_string()) return node->value<std::string>();
  if (node->is_boolean()) return *node->value<bool>() ? "true" : "false";
  if (node->is_integer()) return std::to_string(*node->value<std::int64_t>());
  return to_text(finite_value(state_->path, key, *node));
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, node] : *state_->table) keys.emplace_back(key.str());
  return keys;
}

bool TomlTable::has(const std::string& key) const { return state_->table->contains(key); }

void TomlTable::only(const std::vector<std::string>& known) const {
  for (const auto& [key, node] : *state_->table) {
    const std::string name(key.str());
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string nearest = nearest_name(name, known);
    std::string expected;
    for (const std::string& each : known) expected += (expected.empty() ? "" : ", ") + each;
    throw IoError(state_->path, "line " + std::to_string(key.source().begin.line),
                  "the key " + quoted(name) + " is not known, " +
                      (nearest.empty() ? "expected one of " + expected : "did you mean " + quoted(nearest) + "?"));
  }
}

void TomlTable::fail(const std::string& key, const std::string& problem) const {
  const toml::node* node = state_->find(key);
  fail_at(state_->path, node ? *node : *state_->table, key + ": " + problem);
}

std::string toml_text(const std::string& value) {
  std::string text = "\"";
  for (const char letter : value) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      text += std::string("\\") + letter;
    } else if (code < 0x20 || code == 0x7f) {
      constexpr char kDigits[] = "0123456789abcdef";
      text += std::string("\\u00") + kDigits[code >> 4] + kDigits[code & 15];
    } else {
      text += letter;
    }
  }
  return text + "\"";
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t fewest = name.size() / 3 + 2;
  for (const std::string& other : names) {
    std::vector<std::size_t> changes(other.size() + 1);  // from the letters of `name` so far to those of `other`
    for (std::size_t j = 0; j <= other.size(); ++j) changes[j] = j;
    for (std::size_t i = 1; i <= name.size(); ++i) {
      std::size_t diagonal = changes[0];
      changes[0] = i;
      for (std::size_t j = 1; j <= other.size(); ++j) {
        const std::size_t replaced = diagonal + (name[i - 1] != other[j - 1]);
        diagonal = changes[j];
        changes[j] = std::min({replaced, changes[j] + 1, changes[j - 1] + 1});
      }
    }
    if (changes.back() < fewest) {
      fewest = changes.back();
      nearest = other;
    }
  }
  return nearest;
}

}  // namespace corral
