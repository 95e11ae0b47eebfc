// SPDX-License-Identifier: MIT
#include "apps/study/journal.h"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <tuple>

#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

constexpr char kFormat[] = "corral journal 2";
constexpr std::size_t kHashLength = 32;

std::string line_of(const Json& json) {
  const std::string text = compact_json(json);
  return content_hash(text) + " " + text + "\n";
}

/// The content of a line that agrees with its hash.
std::optional<std::string> content_of(std::string_view line) {
  if (line.size() < kHashLength + 1 || line[kHashLength] != ' ') return std::nullopt;
  std::string content(line.substr(kHashLength + 1));
  if (line.substr(0, kHashLength) != content_hash(content)) return std::nullopt;
  return content;
}

Json to_json(const JournalHeader& header) {
  return {{"format", kFormat},
          {"version", header.identity.version},
          {"commit", header.identity.commit},
          {"experiments_hash", header.identity.experiments},
          {"shard", to_text(header.shard)},
          {"call", corral::to_json(header.call)},
          {"command_line", header.command_line},
          {"machine", header.machine}};
}

JournalHeader header_of(const std::string& path, const std::string& content) {
  try {
    const Json json = Json::parse(content);
    if (json.at("format") != kFormat)
      throw IoError(path, "line 1", "is of the format " + json.at("format").dump() + ", expected " + kFormat);
    return {{json.at("version"), json.at("commit"), json.at("experiments_hash")},
            parse_shard(json.at("shard")),
            study_call_of(json.at("call")),
            json.at("command_line"),
            json.at("machine")};
  } catch (const Json::exception&) {
  } catch (const InvalidInput&) {
  }
  throw IoError(path, "line 1", "is not the header of a journal");
}

std::string text_of(const JournalEntry& entry) {
  return line_of(
      {{"unit", entry.unit}, {"inputs", entry.inputs}, {"seconds", entry.seconds}, {"result", to_json(entry.result)}});
}

std::optional<JournalEntry> entry_of(const std::string& content) {
  try {
    const Json json = Json::parse(content);
    return JournalEntry{json.at("unit"), json.at("inputs").get<std::vector<std::string>>(), json.at("seconds"),
                        unit_result_of(json.at("result"))};
  } catch (const Json::exception&) {
  } catch (const InvalidInput&) {
  }
  return std::nullopt;
}

}  // namespace

std::string StudyIdentity::difference_from(const StudyIdentity& mine) const {
  if (version != mine.version) return "by version " + version + " of the program";
  if (commit != mine.commit) return "by commit " + commit + " of the program";
  if (experiments != mine.experiments) return "from other experiments or settings";
  return "";
}

void JournalWriter::append(const JournalEntry& entry) {
  if (!file_) {
    const std::string units = (fs::path(folder_) / "units").string();
    make_folder(units);
    const std::vector<JournalFile> earlier = find_journals(folder_, header_.shard);
    std::optional<AppendFile> file;
    for (int call = earlier.empty() ? 1 : earlier.front().call + 1; !file; ++call)
      file = AppendFile::create(units + "/" + file_name(header_.shard) + "." + std::to_string(call) + ".journal");
    file->append(line_of(to_json(header_)));
    file_ = std::move(file);  // only with its header
  }
  file_->append(text_of(entry));
}

std::vector<JournalFile> find_journals(const std::string& folder, const std::optional<Shard>& shard) {
  static const std::regex form("([0-9]{1,6})-of-([0-9]{1,6})\\.([0-9]{1,9})\\.journal");
  std::vector<JournalFile> found;
  std::error_code error;
  for (fs::directory_iterator entry(fs::path(folder) / "units", error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::smatch part;
    if (!std::regex_match(name, part, form)) continue;
    const Shard of{std::stoi(part[1]), std::stoi(part[2])};
    if (!shard || of == *shard) found.push_back({entry->path().string(), of, std::stoi(part[3])});
  }
  if (error && error != std::errc::no_such_file_or_directory)
    throw IoError((fs::path(folder) / "units").string(), "", "cannot be read as a folder (" + error.message() + ")");
  std::sort(found.begin(), found.end(), [](const JournalFile& a, const JournalFile& b) {
    return std::tie(a.shard, b.call, a.path) < std::tie(b.shard, a.call, b.path);
  });
  return found;
}

JournalReader::JournalReader(const std::string& path) : text_(read_file(path)) {
  const auto line = next_line();
  if (!line) return;
  const auto content = content_of(*line);
  if (!content) throw IoError(path, "line 1", "does not agree with its hash, expected the header of a journal");
  header_ = header_of(path, *content);
}

std::optional<JournalEntry> JournalReader::next() {
  while (const auto line = next_line()) {
    const auto content = content_of(*line);
    if (auto entry = content ? entry_of(*content) : std::nullopt) return entry;
    damaged_lines_.push_back(line_);
  }
  return std::nullopt;
}

std::optional<std::string_view> JournalReader::next_line() {
  const std::size_t end = text_.find('\n', at_);
  if (end == std::string::npos) return std::nullopt;  // the end, or a line that is not whole
  const std::string_view line(text_.data() + at_, end - at_);
  at_ = end + 1;
  ++line_;
  return line;
}

}  // namespace corral
