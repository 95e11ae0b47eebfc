// SPDX-License-Identifier: MIT
// corral verify: a study computed again, and what is named when it is not what it was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_study.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Verify : public ::testing::Test {
 protected:
  Verify() {
    put_small_dataset(place_);
    place_.put("small.toml", kSmallExperiment);
    const Outcome made = place_.corral("evaluate small.toml --data data -o run --dense --rows all");
    EXPECT_EQ(made.status, 0) << made.err;
  }
  Outcome verify(const std::string& rest) const { return place_.corral("verify run " + rest); }
  std::string selections(const std::string& name) const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(place_ / "run/selections"))
      if (entry.path().filename() == name) return std::filesystem::relative(entry.path(), place_ / "").string();
    return "";
  }
  void change(const std::string& file, const std::string& from, const std::string& to) const {
    place_.put(file, replaced(place_.text(file), from, to));
  }
  const Workplace place_;
};

TEST_F(Verify, AStudyIsWhatItsInputsGive) {
  const Outcome all = verify("--all");
  EXPECT_EQ(all.status, 0) << all.out << all.err;
  EXPECT_EQ(all.out, "");
  EXPECT_THAT(all.err, StartsWith("6 of 6 pairs computed again, "));
  EXPECT_THAT(all.err, HasSubstr(" and 12 files of selections and poses compared; differences: 0\n"));
  const auto json = verify("--sample 2 --seed 5 --jobs 1 --json").json();
  EXPECT_EQ(json["computed_again"], 2);
  EXPECT_EQ(json["pairs"], 6);
  EXPECT_EQ(json["files"], 4);
  EXPECT_EQ(json["records"].get<std::size_t>() * 3, lines_in(place_.text("run/records.csv")) - 1);
  EXPECT_TRUE(json["differences"].empty());
}

// Each step of what a study keeps, changed by hand; the draw decides which pairs are computed, the rest is compared all the same.
TEST_F(Verify, NamesEveryDifference) {
  const std::string poses = selections("m1-0.25.poses.csv"), table = selections("m1-0.25.csv");
  const std::string kept = place_.text(table), records = place_.text("run/records.csv");
  place_.put(table, kept.substr(0, kept.size() - 2) + (kept[kept.size() - 2] == '0' ? "1\n" : "0\n"));
  Outcome outcome = verify("--all");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_EQ(lines_in(outcome.out), 1u) << outcome.out;
  EXPECT_THAT(outcome.out, StartsWith(table + ", line " + std::to_string(lines_in(kept)) + ": is '"));
  EXPECT_THAT(outcome.err, HasSubstr("; differences: 1\n"));
  place_.put(table, kept);

  change(poses, "refined", "refind");
  EXPECT_THAT(verify("--all").out, AllOf(StartsWith(poses + ", line "), HasSubstr("refind"), HasSubstr("refined")));
  change(poses, "refind", "refined");

  std::vector<std::string> lines = lines_of(records);
  lines[3] = replaced(lines[3], ",0.05,", ",0.06,");
  place_.put("run/records.csv", joined(lines));
  outcome = verify("--sample 1");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_EQ(outcome.out,
            "run/records.csv, line 4: level is '0.06' in the study, '0.05' in its journals\n"
            "run/records.csv, line 4: value is '0.06' in the study, '0.05' in its journals\n");
  place_.put("run/records.csv", records + lines[3]);
  EXPECT_THAT(verify("--sample 1").out, HasSubstr(": is no record of the study\n"));
  place_.put("run/records.csv", records);
  EXPECT_EQ(verify("--all").status, 0);
}

// A result that agrees with its hash and with records.csv, but not with what the grouper does.
TEST_F(Verify, ComputesAgainWhatTheJournalSays) {
  const std::string journal = "run/units/1-of-1.1.journal";
  std::vector<std::string> lines = lines_of(place_.text(journal));
  std::string content = lines[1].substr(33);
  const std::size_t at = content.find("\"selected\":") + 11;
  content.replace(at, content.find(',', at) - at, "2000000");
  lines[1] = hashed(content);
  place_.put(journal, joined(lines));
  const Outcome outcome = verify("--all");
  EXPECT_EQ(outcome.status, 4) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr(", small, ss: selected is '2000000' in the study, '"), HasSubstr("pair b3r/m")));
  EXPECT_THAT(outcome.out, HasSubstr("records.csv, line "));
}

TEST_F(Verify, NamesFilesThatAreOthersNow) {
  change("data/b3r/m1-0.25.txt", "1\n", "1 \n");
  Outcome outcome = verify("--all");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.out, HasSubstr("data/b3r/m1-0.25.txt: is not the file that the study was made from\n"));
  std::filesystem::remove(place_ / "data/b3r/m1-0.25.txt");
  outcome = verify("--all");
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("data/b3r/m1-0.25.txt: cannot be read\n"), HasSubstr("pair b3r/m1-0.25, small, gc: ")));
  std::filesystem::remove(place_ / selections("m2-0.05.csv"));
  EXPECT_THAT(verify("--sample 1").out,
              HasSubstr("pair b3r/m2-0.05: has no whole result in units/, or its selections are missing\n"));
}

// A study that comes from elsewhere must not decide what runs here.
TEST_F(Verify, ProgramsAreCalledOnlyWhereTheyMay) {
  const std::string external = " --external 'mine=sh -c \"touch called; echo 0 > {group}\" {matches}'";
  ASSERT_EQ(place_.corral("evaluate small.toml --data data -o other" + external).status, 0);
  std::filesystem::remove(place_ / "called");
  Outcome outcome = place_.corral("verify other --sample 1");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("calls other programs: 'sh -c"), HasSubstr("expected --programs")));
  EXPECT_FALSE(std::filesystem::exists(place_ / "called"));
  outcome = place_.corral("verify other --sample 1 --programs");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(place_ / "called"));
}

TEST_F(Verify, SaysWhatIsWrongWithTheCall) {
  EXPECT_EQ(verify("--sample 0").status, 2);
  EXPECT_EQ(verify("--sample 1 --all").status, 2);
  EXPECT_EQ(place_.corral("verify data").status, 3);
  EXPECT_EQ(place_.corral("verify nowhere").status, 3);
}

}  // namespace
}  // namespace corral
