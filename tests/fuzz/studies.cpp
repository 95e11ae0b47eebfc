// SPDX-License-Identifier: MIT
// What a study is made from and what it leaves: the readers of apps/.
#include "apps/claims/claim_file.h"
#include "apps/pair/confidence_file.h"
#include "apps/pair/external_method.h"
#include "apps/pair/foreign_answer.h"
#include "apps/results/study_folder.h"
#include "apps/runtime/child_program.h"
#include "apps/study/content_store.h"
#include "apps/study/journal.h"
#include "apps/study/methods_file.h"
#include "grouping/registry.h"
#include "kernel/synthetic.h"
#include "tests/fuzz/target.h"

namespace corral::fuzz {
namespace {

void experiment(const std::string& bytes) {
  const Experiment read = parse_experiment("file", bytes);
  require(read.info.name.find_first_of("/.") == std::string::npos, "the name of an experiment is a name of a file");
}

void methods(const std::string& bytes) {
  for (const ForeignMethod& method : parse_methods("file", bytes))
    require(is_method_name(method.name), "a method has a name");
}

void claims(const std::string& bytes) { parse_claims("file", bytes); }

void confidence(const std::string& bytes) {
  const std::string written = confidence_text(parse_confidence("file", bytes));
  require(confidence_text(parse_confidence("again", written)) == written, "a model read again is the same");
}

void records(const std::string& bytes) {
  for (const StudyRecord& record : read_records(in_file(bytes, "records.csv"))) {
    std::string header;
    for (const std::string& name : record_columns()) header += (header.empty() ? "" : ",") + name;
    const std::string line = record_line(record), file = in_file(header + "\n" + line, "again.csv");
    require(record_line(read_records(file).at(0)) == line, "a record read again is the same");
  }
}

void selections(const std::string& bytes) {
  const PairSelections read = read_selections(in_file(bytes, "selections.csv"));
  for (const auto& [method, rows] : read.selected)
    for (const int row : rows)
      require(row >= 0 && static_cast<std::size_t>(row) < read.matches, "a row is in the table");
}

void poses(const std::string& bytes) {
  const std::string written = poses_text(read_poses(in_file(bytes, "poses.csv")));
  require(poses_text(read_poses(in_file(written, "again.csv"))) == written, "poses read again are the same");
}

/// A manifest, and behind a zero the records.
void study(const std::string& bytes) {
  const std::size_t half = std::min(bytes.find('\0'), bytes.size());
  const std::string manifest = in_file(std::string_view(bytes).substr(0, half), "manifest.json");
  in_file(half < bytes.size() ? bytes.substr(half + 1) : "", "records.csv");
  read_study(manifest.substr(0, manifest.rfind('/')));
}

void read_journal(const std::string& path) {
  JournalReader reader(path);
  while (reader.next()) {
  }
}

/// As it is, and with hashes that agree.
void journal(const std::string& bytes) {
  std::string hashed;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    const std::string line = bytes.substr(at, end - at);
    hashed += content_hash(line) + " " + line + "\n";
    at = end + 1;
  }
  read_journal(in_file(hashed, "1-of-1.2.journal"));
  read_journal(in_file(bytes, "1-of-1.1.journal"));
}

/// A stored result whose hash agrees.
void cache(const std::string& bytes) {
  const std::string key(32, '0'), file = in_file(content_hash(bytes) + bytes, key);
  static const ContentStore store(file.substr(0, file.rfind('/')));
  if (const auto found = store.matches(key)) found->matches.validate();
  store.descriptors(key);
}

/// NAME.OPTION=VALUE for any grouper, words, names of shards and statuses.
void options(const std::string& bytes) {
  parse_status(bytes);
  for (const Grouper& grouper : groupers())
    for (const OptionValue& option : grouper.options) try {
        const ConfiguredGrouper made = grouper.configure({{option.name, bytes}});
        OptionOverrides again;
        for (const OptionValue& each : made.options) again[each.name] = each.value;
        grouper.configure(again);
      } catch (const InvalidInput&) {
      }
  try {
    for (const std::string& word : split_words(bytes))
      require(split_words(shell_word(word)).size() == 1, "a word is one");
    parse_external(bytes);
  } catch (const InvalidInput&) {
  }
  parse_shard(bytes);
}

/// What another program answers: a selection, and behind a zero a pose.
void answer(const std::string& bytes) {
  static const CorrespondenceSet matches = [] {
    SyntheticOptions options;
    options.matches = 8;
    return make_synthetic_problem(options).matches;
  }();
  const std::size_t half = std::min(bytes.find('\0'), bytes.size());
  ForeignAnswer answer;
  answer.labels = half > 0 ? in_file(std::string_view(bytes).substr(0, half), "group.csv") : "";
  answer.pose = half < bytes.size() || half == 0
                    ? in_file(std::string_view(bytes).substr(std::min(half + 1, bytes.size())), "pose.txt")
                    : "";
  const GroupingResult read = read_answer(answer, matches);
  for (const int row : read.selected) require(row >= 0 && row < matches.size(), "a row is in the table");
}

}  // namespace

const std::vector<Target>& study_targets() {
  static const std::vector<Target> all = {{"experiment", experiment}, {"methods", methods}, {"claims", claims},
                                          {"confidence", confidence}, {"records", records}, {"selections", selections},
                                          {"poses", poses},           {"study", study},     {"journal", journal},
                                          {"cache", cache},           {"options", options}, {"answer", answer}};
  return all;
}

}  // namespace corral::fuzz
