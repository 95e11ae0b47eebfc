// SPDX-License-Identifier: MIT
// Files that somebody else has made: nothing in them is run, and nothing is written outside of the output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/hostile_names.h"
#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using nlohmann::json;
using ::testing::HasSubstr;

class Security : public ::testing::Test {
 protected:
  Security() {
    put_small_dataset(place_);
    place_.put("small.toml", kSmallExperiment);
  }
  Outcome evaluate(const std::string& rest) const { return place_.corral("evaluate small.toml --data data " + rest); }

  /// All files but those in the folder of the output, and what lies beside the working folder.
  std::set<std::string> others(const std::string& output) const {
    std::set<std::string> found;
    for (auto entry = std::filesystem::recursive_directory_iterator(place_ / ""); entry != end(entry); ++entry) {
      if (entry->path() == place_ / output) entry.disable_recursion_pending();
      if (entry->path() != place_ / output) found.insert(entry->path().string());
    }
    for (const char* above : {"../hacked", "../../hacked", "../hacked.csv", "../../hacked.csv"})
      if (std::filesystem::exists(place_ / above)) found.insert(above);
    return found;
  }
  const Workplace place_;
};

/// In TOML's quotes, where that can hold it.
std::string toml_string(const std::string& name) {
  std::string text = "\"";
  for (const char letter : name)
    if (letter == '"' || letter == '\\')
      text += std::string("\\") + letter;
    else if (static_cast<unsigned char>(letter) < ' ' || letter == 127)
      text += "\\u00" + std::string(letter == 127 ? "7f" : letter == '\n' ? "0a" : letter == '\t' ? "09" : "1b");
    else
      text += letter;
  return text + "\"";
}

TEST_F(Security, NamesOfPairsSetsExperimentsAndMethodsAreChecked) {
  const std::string pairs = place_.text("data/b3r/pairs.csv"), set = place_.text("data/b3r/dataset.toml");
  const auto before = others("run");
  const auto refused = [&](const std::string& file, const std::string& content, const std::string& name) {
    const std::string kept = place_.text(file);
    place_.put(file, content);
    const Outcome outcome = evaluate("-o run");
    EXPECT_EQ(outcome.status, 3) << file << ": " << name.substr(0, 50);
    EXPECT_LT(outcome.err.size(), 1000u);
    EXPECT_EQ(lines_in(outcome.err), 1u) << outcome.err;
    place_.put(file, kept);
    EXPECT_EQ(others("run"), before) << name.substr(0, 50);
  };
  for (const std::string& name : hostile_names()) {
    if (name == "__proto__") continue;  // a name like any other here
    if (name.find('\n') == std::string::npos)
      refused("data/b3r/pairs.csv",
              replaced(pairs, "m1-0.05,", csv_line({name, "", ""}).substr(0, csv_line({name, "", ""}).size() - 2)),
              name);
    refused("data/b3r/dataset.toml", replaced(set, "\"b3r\"", toml_string(name)), name);
    refused("small.toml", replaced(kSmallExperiment, "\"small\"", toml_string(name)), name);
    place_.put("methods.toml", "[[method]]\nname = " + toml_string(name) + "\nlabels = \"{pair}.txt\"\n");
    EXPECT_EQ(evaluate("-o run --methods methods.toml").status, 3) << name.substr(0, 50);
    std::filesystem::remove(place_ / "methods.toml");
  }
}

// The names in a study are those that were checked when it was made, unless somebody wrote it by hand.
TEST_F(Security, AReportOfAForeignStudyStaysInItsFolder) {
  ASSERT_EQ(evaluate("-o run").status, 0);
  json manifest = json::parse(place_.text("run/manifest.json"));
  CsvTable records = parse_csv("records", place_.text("run/records.csv"));
  std::string name = "../../hacked";
  for (const std::string& each : hostile_names())
    if (each.find('\n') == std::string::npos && each.size() < 100 && static_cast<unsigned char>(each[0]) < 128)
      name += each;
  const auto before = others("report");
  json changed = manifest;
  changed["experiments"][0]["name"] = changed["experiments"][0]["dataset"] = name;
  changed["experiments"][0]["methods"][0] = changed["experiments"][0]["title"] = name;
  changed["experiments"][0]["levels"][0]["label"] = name;
  json pairs;
  for (const auto& [pair, files] : manifest["pairs"].items()) pairs[name + pair.substr(3)] = files;
  changed["pairs"] = pairs;
  CsvTable rows = records;
  for (auto& row : rows.rows) {
    for (const char* column : {"experiment", "dataset"}) row[static_cast<std::size_t>(rows.column(column))] = name;
    std::string& method = row[static_cast<std::size_t>(rows.column("method"))];
    if (method == manifest["experiments"][0]["methods"][0]) method = name;
    std::string& level = row[static_cast<std::size_t>(rows.column("level"))];
    if (level == manifest["experiments"][0]["levels"][0]["label"]) level = name;
  }
  place_.put("run/manifest.json", changed.dump());
  place_.put("run/records.csv", csv_text(rows));
  const auto with_study = others("report");
  EXPECT_EQ(with_study, before);
  const Outcome outcome = place_.corral("report run -o report");
  EXPECT_LE(outcome.status, 4) << outcome.err;
  EXPECT_NE(outcome.status, 1) << outcome.err;
  EXPECT_EQ(others("report"), before) << outcome.err;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(place_ / "report"))
    EXPECT_NE(entry.path().filename(), "hacked");
}

// A link in the folder of a shard leads elsewhere; what it is called in there decides where it is copied to.
TEST_F(Security, MergeCopiesIntoItsFolderAlone) {
  ASSERT_EQ(evaluate("-o one --shard 1/2").status, 0);
  ASSERT_EQ(evaluate("-o two --shard 2/2").status, 0);
  std::filesystem::create_directories(place_ / "deep/secret");
  place_.put("deep/secret/notes.csv", "a,b\n");
  std::filesystem::create_symlink(place_ / "deep/secret/notes.csv", place_ / "two/selections/linked.csv");
  const auto before = others("one");
  EXPECT_EQ(place_.corral("merge one two").status, 0);
  EXPECT_EQ(others("one"), before);
  EXPECT_TRUE(std::filesystem::exists(place_ / "one/selections/linked.csv"));
}

// Not from what files say, but from what a user types: words stay words.
TEST_F(Security, NoShellSeesAnExternalCommand) {
  place_.put_problem();
  const Outcome outcome = place_.corral(
      "run --matches matches.csv --methods gc --external 'mine=cat {matches} {group} ; touch hacked' --json");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_FALSE(std::filesystem::exists(place_ / "hacked"));
  EXPECT_THAT(outcome.out, HasSubstr("touch"));
}

}  // namespace
}  // namespace corral
