// SPDX-License-Identifier: MIT
// What the program does when it cannot do what is asked: one sentence, an exit status by cause, nothing half-written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace corral {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::lines_in;
using ::testing::Not;
using testing::Outcome;
using testing::replaced;
using ::testing::StartsWith;
using testing::Workplace;

/// Wrong usage: status 2, something on stderr that says what, nothing on stdout.
void expect_usage(const Outcome& outcome, const std::string& says) {
  EXPECT_EQ(outcome.status, 2) << says;
  EXPECT_EQ(outcome.out, "") << says;
  EXPECT_THAT(outcome.err, HasSubstr(says));
}

/// Bad input: status 3, one line on stderr, nothing on stdout.
void expect_bad_input(const Outcome& outcome, const std::string& says) {
  EXPECT_EQ(outcome.status, 3) << says;
  EXPECT_EQ(outcome.out, "") << says;
  EXPECT_THAT(outcome.err, AllOf(StartsWith("corral: "), HasSubstr(says)));
  EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
}

TEST(Usage, ACommandIsNeeded) {
  const Workplace place;
  expect_usage(place.corral(""), "subcommand is required");
  expect_usage(place.corral("banana"), "unknown command 'banana', expected one of those in corral --help");
  expect_usage(place.corral("evalute"), "unknown command 'evalute', did you mean 'evaluate'?");
  expect_usage(place.corral("dataset"), "subcommand is required");
  expect_usage(place.corral("dataset chek data"), "unknown command 'chek', did you mean 'check'?");
  expect_usage(place.corral("dataset make shelf"), "expected one of those in corral dataset make --help");
  expect_usage(place.corral("info"), "mesh");
  expect_usage(place.corral("info --banana a.ply"), "--banana");
  expect_usage(place.corral("match one.ply"), "target");
  expect_usage(place.corral("score matches.csv group.csv"), "--truth");
  expect_usage(place.corral("groupers --json --markdown"), "excludes");
}

TEST(Usage, AMethodThatIsNotThereIsAnsweredWithThoseThatAre) {
  const Workplace place;
  place.put_problem();
  const std::string known = "ss|nnsr|ransac|st|gc|hough|si";
  expect_usage(place.corral("group matches.csv -m banana"), known);
  expect_usage(place.corral("group matches.csv -m GC"), known);
  expect_usage(place.corral("group missing.csv -m banana"), known);
  expect_usage(place.corral("run a.ply b.ply --methods gc,banana"), known);
  expect_usage(place.corral("run a.ply b.ply --methods gc,gc"), "gc occurs twice");
  expect_usage(place.corral("run a.ply b.ply --methods ''"), "--methods");
}

TEST(Usage, AnOptionThatIsNotThereIsAnsweredWithThoseThatAre) {
  const Workplace place;
  place.put_problem();
  const auto set = [&](const std::string& settings) {
    return place.corral("group matches.csv -o g.csv -m ransac " + settings);
  };
  const Outcome unknown = set("--set ransac.tolerance=3");
  expect_usage(unknown, "tolerance");
  for (const char* name : {"iterations", "tolerance_pr", "seed"}) EXPECT_THAT(unknown.err, HasSubstr(name));
  expect_usage(set("--set ransac.tolerance_pr=0"), "tolerance_pr is 0, expected");
  expect_usage(set("--set ransac.tolerance_pr=nan"), "tolerance_pr is nan, expected");
  expect_usage(set("--set ransac.iterations=many"), "iterations is 'many', expected");
  expect_usage(set("--set ransac.iterations=2.5"), "iterations is '2.5', expected");
  expect_usage(set("--set ransac.seed=1 --set ransac.seed=2"), "set twice");
  for (const char* bad : {"seed", "seed=1", "=1", ".seed=1", "ransac.=1", "ransac.seed"})
    expect_usage(set("--set " + std::string(bad)), "expected NAME.OPTION=VALUE");
  expect_usage(set("--set gc.tolerance_pr=1"), "gc is not in use here, expected an option of ransac");
  expect_usage(set("--set ransack.seed=1"), "did you mean 'ransac'?");
  expect_usage(set("--repeat 0"), "--repeat");
  expect_usage(set("--repeat x"), "--repeat");
  EXPECT_THAT(place.names(), Not(::testing::Contains("g.csv")));
}

TEST(Usage, LengthsArePositiveAndFinite) {
  const Workplace place;
  place.put_problem();
  write_mesh(place / "a.ply", testing::icosphere(1));
  for (const char* bad : {"-1", "nan", "inf", "x"}) {
    const std::string value(bad);
    expect_usage(place.corral("score matches.csv group.csv --truth truth.txt --threshold-pr " + value),
                 "--threshold-pr");
    expect_usage(place.corral("refine matches.csv group.csv --truth truth.txt --threshold-pr " + value),
                 "--threshold-pr");
    expect_usage(place.corral("run a.ply a.ply --truth truth.txt --threshold-pr " + value), "--threshold-pr");
    expect_usage(place.corral("perturb a.ply -o b.ply --noise-pr " + value), "--noise-pr");
  }
  expect_usage(place.corral("refine matches.csv group.csv --loss tuckey"),
               "--loss: found 'tuckey', expected none, huber, cauchy, tukey, geman-mcclure");
  for (const char* bad : {"0", "-1", "nan", "inf", "x"}) {
    const std::string value(bad);
    expect_usage(place.corral("refine matches.csv group.csv --loss-scale-pr " + value), "--loss-scale-pr");
    expect_usage(place.corral("match a.ply a.ply --keypoint-radius-pr " + value), "--keypoint-radius-pr");
    expect_usage(place.corral("match a.ply a.ply --support-radius-pr " + value), "--support-radius-pr");
    expect_usage(place.corral("run a.ply a.ply --support-radius-pr " + value), "--support-radius-pr");
    expect_usage(place.corral("match a.ply a.ply --resolution " + value), "resolution");
  }
}

TEST(BadInput, EveryCommandNamesTheFileThatIsMissing) {
  const Workplace place;
  place.put_problem();
  write_mesh(place / "a.ply", testing::icosphere(1));
  for (const char* command :
       {"info no.ply", "match no.ply a.ply", "match a.ply no.ply", "run no.ply a.ply", "run a.ply no.ply",
        "run a.ply a.ply --truth no.ply", "perturb no.ply -o b.ply", "triangulate no.ply -o b.ply",
        "group no.ply -m gc", "refine no.ply group.csv", "refine matches.csv no.ply",
        "refine matches.csv group.csv --truth no.ply", "refine matches.csv group.csv --start no.ply",
        "score no.ply group.csv --truth truth.txt", "score matches.csv no.ply --truth truth.txt",
        "score matches.csv group.csv --truth no.ply"}) {
    SCOPED_TRACE(command);
    expect_bad_input(place.corral(command), "no.ply: does not exist");
  }
}

TEST(BadInput, AFolderThatIsNotWhatTheCommandReadsIsNamedWithWhatIs) {
  const Workplace place;
  for (const char* command : {"report folder -o out", "claims folder", "compare folder"}) {
    SCOPED_TRACE(command);
    expect_bad_input(place.corral(command), "expected a folder that 'corral evaluate' made");
  }
  for (const char* command : {"dataset check folder", "dataset measure folder"}) {
    SCOPED_TRACE(command);
    expect_bad_input(place.corral(command), "expected the folder of one data set");
  }
  expect_bad_input(place.corral("evaluate noise --data folder -o run"), "folder: is not a folder");
  place.put("points.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  expect_bad_input(place.corral("scan points.xyz -o view.ply"), "points.xyz: has no faces");
  EXPECT_THAT(place.names(), ElementsAre("points.xyz"));
}

TEST(BadInput, MatchesAreDrawnOnTheMeshesThatWereMatched) {
  const Workplace place;
  place.put_pair();
  ASSERT_EQ(place.corral("match model.ply copy.ply -o m.csv").status, 0);
  EXPECT_EQ(place.corral("draw model.ply copy.ply --matches m.csv --width 200 -o right.png").status, 0);
  expect_bad_input(place.corral("draw copy.ply copy.ply --matches m.csv -o wrong.png"), "of the source, expected");
  expect_bad_input(place.corral("draw model.ply model.ply --matches m.csv -o wrong.png"), "of the target, expected");
  write_mesh(place / "small.ply", testing::icosphere(0));
  expect_bad_input(place.corral("draw small.ply copy.ply --matches m.csv -o wrong.png"), "of the source, expected");
  EXPECT_FALSE(std::filesystem::exists(place / "wrong.png"));
}

TEST(BadInput, EveryCommandRefusesMalformedFiles) {
  const Workplace place;
  place.put_problem();
  write_mesh(place / "good.ply", testing::icosphere(1));
  const std::string mesh = place.text("good.ply"), matches = place.text("matches.csv");
  place.put("cut.ply", mesh.substr(0, mesh.size() / 2));
  place.put("cut.csv", matches.substr(0, matches.size() - 5));
  place.put("empty.ply", "");
  place.put("inf.off", "OFF\n1 0 0\ninf 0 0\n");
  place.put("corner.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n");
  place.put("zero.csv", replaced(matches, "# resolution 1", "# resolution 0"));
  place.put("short.csv", group_text({99, {}, {}}));
  place.put("scaled.txt", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n");
  std::filesystem::create_directory(place / "folder.ply");
  const std::vector<std::pair<std::string, std::string>> said = {
      {"match cut.ply good.ply", "cut.ply, line"},
      {"run good.ply cut.ply", "cut.ply, line"},
      {"info empty.ply", "empty.ply: the file is empty"},
      {"info folder.ply", "folder.ply: is a directory"},
      {"info /dev/null", "/dev/null: is a device"},
      {"info inf.off", "inf.off, line 3: found 'inf', expected a finite number"},
      {"perturb corner.off -o b.ply", "corner.off, line 6: a corner is '3', expected a whole number in 0 .. 2"},
      {"group cut.csv -m gc -o g.csv", "cut.csv, line"},
      {"group zero.csv -m gc -o g.csv", "zero.csv, line 2: the resolution is '0', expected a length above zero"},
      {"score matches.csv short.csv --truth truth.txt", "short.csv: has 99 rows, expected 100, one per match"},
      {"refine matches.csv short.csv", "short.csv: has 99 rows, expected 100, one per match"},
      {"score matches.csv group.csv --truth scaled.txt", "scaled.txt, rotation: not rigid"},
      {"refine matches.csv group.csv --truth scaled.txt -o pose.txt", "det R is 8"},
      {"refine matches.csv group.csv --start scaled.txt -o pose.txt", "scaled.txt, rotation: not rigid"},
      {"run good.ply good.ply --truth scaled.txt -o out", "scaled.txt, rotation: not rigid"}};
  const auto before = place.names();
  for (const auto& [command, sentence] : said) {
    SCOPED_TRACE(command);
    expect_bad_input(place.corral(command), sentence);
  }
  EXPECT_EQ(place.names(), before) << "a command that fails leaves nothing behind";
}

TEST(BadInput, AMeshWithoutAResolutionIsNamed) {
  const Workplace place;
  write_mesh(place / "good.ply", testing::icosphere(1));
  place.put("none.off", "OFF\n0 0 0\n");
  place.put("same.off", "OFF\n3 0 0\n1 2 3\n1 2 3\n1 2 3\n");
  for (const char* bad : {"none.off", "same.off"}) {
    expect_bad_input(place.corral("match good.ply " + std::string(bad)), bad);
    expect_bad_input(place.corral("run " + std::string(bad) + " good.ply"), bad);
    expect_bad_input(place.corral("perturb " + std::string(bad) + " --noise-pr 1 -o b.ply"), bad);
  }
}

TEST(BadInput, AnOutputThatCannotBeWrittenLeavesNothing) {
  const Workplace place;
  place.put_problem();
  write_mesh(place / "a.ply", testing::icosphere(1));
  const auto before = place.names();
  for (const char* command :
       {"match a.ply a.ply -o nowhere/m.csv", "group matches.csv -m gc -o nowhere/g.csv",
        "refine matches.csv group.csv -o nowhere/p.txt", "run a.ply a.ply -o matches.csv/out",
        "perturb a.ply --truth nowhere/t.txt -o b.ply", "perturb a.ply --truth t.txt -o nowhere/b.ply"}) {
    SCOPED_TRACE(command);
    const Outcome outcome = place.corral(command);
    EXPECT_EQ(outcome.status, 3);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("corral: "), HasSubstr("cannot be created")));
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(place.names(), before);
  }
}

TEST(BadInput, AFailureKeepsTheOlderOutput) {
  const Workplace place;
  place.put_problem();
  const std::string older = place.text("group.csv");
  place.put("bad.csv", "# corral matches 1\n");
  EXPECT_EQ(place.corral("group bad.csv -m gc -o group.csv").status, 3);
  EXPECT_EQ(place.text("group.csv"), older);
}

TEST(BadInput, StandardOutputThatIsFullIsAnError) {
  const Workplace place;
  place.put_problem();
  expect_bad_input(place.corral("group matches.csv -m gc >/dev/full"), "standard output: cannot be written");
  expect_bad_input(place.corral("group matches.csv -m gc -o /dev/full"), "/dev/full: cannot be written");
}

// File names are bytes; JSON is UTF-8.
TEST(BadInput, ANameThatIsNoUtf8IsStillAnswered) {
  const Workplace place;
  write_mesh(place / "a\xff.ply", testing::icosphere(1));
  place.put(
      "a.ply",
      "ply\nformat ascii 1.0\nelement \xff 9\nproperty int a\nelement vertex 0\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n");
  EXPECT_EQ(place.corral("info a\xff.ply --json").status, 0);
  EXPECT_EQ(place.corral("info a.ply --json").status, 3);
}

}  // namespace
}  // namespace corral
