// SPDX-License-Identifier: MIT
#include "io/matches/group_file.h"

#include "io/disk/file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

GroupTable read_group(const std::string& path) {
  const std::string content = read_file(path);
  if (content.empty()) throw IoError(path, "", "the file is empty, expected the header row,selected,score");
  LineReader reader(path, content);
  reader.need("the header row,selected,score");
  if (reader.line() != "row,selected,score")
    reader.fail("found " + quoted(reader.line()) + ", expected the header row,selected,score");
  GroupTable group;
  while (reader.next()) {
    const auto& fields = reader.fields(',');
    if (fields.size() != 3)
      reader.fail("found " + std::to_string(fields.size()) + " fields, expected row,selected,score");
    reader.integer(fields[0], group.matches, group.matches, "the row");
    if (reader.integer(fields[1], 0, 1, "selected") == 1) group.selected.push_back(group.matches);
    if (!fields[2].empty()) group.scores.push_back(reader.finite_number(fields[2]));
    ++group.matches;
    if (!group.scores.empty() && group.scores.size() != static_cast<std::size_t>(group.matches))
      reader.fail("some rows have a score and some have none, expected all or none");
  }
  return group;
}

GroupTable read_group_of(const std::string& path, int matches) {
  GroupTable group = read_group(path);
  if (group.matches != matches)
    throw IoError(
        path, "",
        "has " + std::to_string(group.matches) + " rows, expected " + std::to_string(matches) + ", one per match");
  return group;
}

std::string group_text(const GroupTable& group) {
  std::string text = "row,selected,score\n";
  auto next = group.selected.begin();
  for (int row = 0; row < group.matches; ++row) {
    const bool selected = next != group.selected.end() && *next == row;
    next += selected;
    text += std::to_string(row) + (selected ? ",1," : ",0,");
    if (!group.scores.empty()) text += to_text(group.scores[static_cast<std::size_t>(row)]);
    text += "\n";
  }
  return text;
}

}  // namespace corral
