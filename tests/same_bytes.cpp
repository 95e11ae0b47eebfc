// SPDX-License-Identifier: MIT
// What every grouper finds on 50 tables, in a form that builds can be compared by (tests/portability bytes): table, grouper, hashes
// of its selection and scores, and its pose, between tabs. Ends with 1 if two vector targets of this machine differ.
#include <cstdio>
#include <cstring>
#include <string>

#include "grouping/registry.h"
#include "kernel/random.h"
#include "tests/support/degenerate_tables.h"
#include "tests/support/execution.h"
#include "tests/support/random_tables.h"

namespace {

using namespace corral;

/// Of the bits, so that 0 and -0 differ.
template <class Value>
std::uint64_t hash_of(const std::vector<Value>& values) {
  std::string bytes(values.size() * sizeof(Value), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return derive_seed(values.size(), bytes);
}

std::string text_of(const GroupingResult& found) {
  char text[64];
  std::snprintf(text, sizeof text, "%016llx %016llx", static_cast<unsigned long long>(hash_of(found.selected)),
                static_cast<unsigned long long>(hash_of(found.scores)));
  std::string line = text;
  if (!found.target_from_source) return line;
  line += "\t";
  const auto add = [&](double number) {
    std::snprintf(text, sizeof text, "%.17g ", number);
    line += text;
  };
  for (const double entry : found.target_from_source->rotation.reshaped()) add(entry);
  for (const double entry : found.target_from_source->translation) add(entry);
  return line;
}

std::string answer(const GroupFunction& group, const CorrespondenceSet& table) {
  try {
    return text_of(group(table));
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

int main() {
  std::vector<testing::DegenerateTable> tables = testing::degenerate_tables();
  for (int number = 0; tables.size() < 50; ++number) {
    RandomStream random = testing::stream_of_case(number);
    tables.push_back({"random-" + std::to_string(number),
                      number % 3 == 0 ? testing::table_on_the_limits(random) : testing::random_table(random)});
  }
  int status = 0;
  for (const testing::DegenerateTable& table : tables)
    for (const Grouper& grouper : groupers()) {
      const GroupFunction group = grouper.configure({}).group;
      std::string first;
      for (const std::int64_t target : testing::available_targets()) {
        const testing::ForcedTarget forced(target);
        const std::string line = answer(group, table.matches);
        if (first.empty()) first = line;
        if (line == first) continue;
        status = 1;
        std::fprintf(stderr, "%s on %s: %s differs\n", grouper.name.c_str(), table.name.c_str(),
                     testing::target_name(target).c_str());
      }
      std::printf("%s\t%s\t%s\n", table.name.c_str(), grouper.name.c_str(), first.c_str());
    }
  return status;
}
