// SPDX-License-Identifier: MIT
#include "apps/scoreboard/submission.h"

#include <filesystem>
#include <map>
#include <stdexcept>

#include "apps/runtime/stopwatch.h"
#include "apps/study/content_store.h"
#include "apps/study/methods_file.h"
#include "io/matches/group_file.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"
#include "io/text/csv_file.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string table_of(const Dataset& dataset, const DatasetPair& pair) {
  if (pair.matches.empty())
    throw IoError(dataset.path("pairs.csv"), pair.name,
                  "has no table of matches, expected one in the column matches; 'corral dataset make tables' makes "
                  "them from surfaces");
  return dataset.path(pair.matches);
}

std::string method_toml(const Submission& facts) {
  std::string text = "# Made by 'corral scoreboard pack'.\n";
  const auto add = [&](const char* key, const std::string& value) {
    text += std::string(key) + " = " + toml_text(value) + "\n";
  };
  add("name", facts.name), add("title", facts.title), add("dataset", facts.dataset);
  add("url", facts.url), add("licence", facts.licence), add("needs", facts.needs);
  return text + "deterministic = " + (facts.is_deterministic ? "true" : "false") + "\n";
}

}  // namespace

std::string Submission::methods_text() const {
  return "[[method]]\nname = " + toml_text(name) + "\ntitle = " + toml_text(title) +
         "\nlabels = \"labels/{pair}.csv\"\n" + (has_poses ? "poses = \"poses/{pair}.txt\"\n" : "") +
         "times = \"times.csv\"\n";
}

Submission read_submission(const std::string& folder) {
  const std::string path = folder + "/method.toml";
  const TomlTable table = TomlTable::read(path);
  table.only({"name", "title", "dataset", "url", "licence", "needs", "deterministic"});
  Submission found;
  found.folder = folder;
  found.name = table.text("name").value_or("");
  if (!is_method_name(found.name))
    table.fail("name", "found " + corral::quoted(found.name) +
                           ", expected letters, digits and . _ + - only, and no name of a method of Corral");
  found.title = table.text("title").value_or(found.name);
  found.dataset = table.text("dataset").value_or("");
  if (found.dataset.empty()) table.fail("dataset", "expected the name of the data set");
  found.url = table.text("url").value_or(""), found.licence = table.text("licence").value_or("");
  found.needs = table.text("needs").value_or("");
  found.is_deterministic = table.flag("deterministic").value_or(false);
  std::error_code ignored;
  found.has_poses =
      std::filesystem::directory_iterator(folder + "/poses", ignored) != std::filesystem::directory_iterator();
  return found;
}

std::vector<FileContent> pack_submission(const SubmittedMethod& method, const Dataset& dataset,
                                         const std::string& folder,
                                         const std::function<void(const std::string& pair)>& observer) {
  Submission facts = method.facts;
  facts.dataset = dataset.name;
  std::vector<FileContent> files = {{folder + "/method.toml", method_toml(facts)}};
  CsvTable tables{{"pair", "hash", "matches"}, {}}, times{{"pair", "ms"}, {}};
  for (const DatasetPair& pair : dataset.pairs) {
    const std::string path = table_of(dataset, pair);
    if (observer) observer(pair.name);
    const CorrespondenceSet matches = read_matches(path);
    tables.rows.push_back({pair.name, content_hash(read_file(path)), std::to_string(matches.size())});
    GroupingResult found;
    Stopwatch watch;
    try {
      found = method.group(matches);
    } catch (const std::runtime_error&) {
      continue;
    } catch (const std::invalid_argument&) {
      continue;
    }
    times.rows.push_back({pair.name, to_text(watch.lap_ms())});
    files.push_back(
        {folder + "/labels/" + pair.name + ".csv", group_text({matches.size(), found.selected, found.scores})});
    if (found.target_from_source)
      files.push_back({folder + "/poses/" + pair.name + ".txt", transform_text(*found.target_from_source)});
  }
  files.push_back({folder + "/tables.csv", csv_text(tables)});
  files.push_back({folder + "/times.csv", csv_text(times)});
  return files;
}

std::vector<std::string> check_submission(const Submission& submission, const Dataset& dataset) {
  std::vector<std::string> problems;
  if (submission.dataset != dataset.name)
    problems.push_back("it is of the data set " + submission.dataset + ", expected " + dataset.name);
  const std::string listed = submission.folder + "/tables.csv";
  const CsvTable tables = read_csv(listed);
  const int names = tables.column("pair"), hashes = tables.column("hash");
  if (names < 0 || hashes < 0) throw IoError(listed, "header", "expected the columns pair and hash");
  std::map<std::string, std::string> hash_of;
  for (const auto& row : tables.rows)
    hash_of[row[static_cast<std::size_t>(names)]] = row[static_cast<std::size_t>(hashes)];
  for (const DatasetPair& pair : dataset.pairs) {
    const std::string path = table_of(dataset, pair);
    const auto found = hash_of.find(pair.name);
    if (found == hash_of.end()) {
      problems.push_back("it does not know the table " + pair.name);
      continue;
    }
    if (found->second != content_hash(read_file(path)))
      problems.push_back("its table " + pair.name + " is not that of the data set");
    hash_of.erase(found);
    const std::string labels = submission.folder + "/labels/" + pair.name + ".csv",
                      pose = submission.folder + "/poses/" + pair.name + ".txt";
    std::error_code ignored;
    try {
      if (std::filesystem::exists(labels, ignored)) read_group_of(labels, read_matches(path).size());
      if (std::filesystem::exists(pose, ignored)) read_transform(pose);
    } catch (const IoError& error) {
      problems.push_back(error.what());
    }
  }
  for (const auto& [pair, hash] : hash_of)
    problems.push_back("it has the table " + pair + ", which the data set lacks");
  return problems;
}

}  // namespace corral
