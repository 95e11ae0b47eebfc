// SPDX-License-Identifier: MIT
#include "apps/pair/external_method.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/matches/group_file.h"
#include "io/pose/transform_file.h"
#include "kernel/synthetic.h"
#include "tests/io/array/npy_encoder.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string parse_error(const std::string& text) {
  try {
    parse_external(text);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

/// A table with 60 correct ones among 100 matches, and programs as scripts of a shell.
class External : public ::testing::Test {
 protected:
  External() {
    SyntheticOptions options;
    options.matches = 100;
    options.inlier_ratio = 0.6;
    options.noise_pr = 0.3;
    made_ = make_synthetic_problem(options);
    truth_.target_from_source = made_.truth;
    truth_.overlap = made_.matches.source_points(made_.inliers, Eigen::all);
  }
  /// The script has the files of the call as $matches, $group and $pose.
  ExternalMethod method(const std::string& script, const std::string& words = "{matches} {group} {pose}") const {
    put_text(folder_ / "mine.sh", "matches=$1\ngroup=$2\npose=$3\n" + script);
    ExternalMethod external = parse_external("mine=sh " + (folder_ / "mine.sh") + " " + words);
    external.timeout_s = 20;
    return external;
  }
  MethodRecord evaluate(const ExternalMethod& external) const {
    return evaluate_external(external, made_.matches, truth_, 1);
  }
  std::string failure(const std::string& script) const {
    const MethodRecord record = evaluate(method(script));
    EXPECT_THAT(record.found.selected, ::testing::IsEmpty());
    EXPECT_EQ(record.status().state, MethodState::Failed);
    return record.failure;
  }

  SyntheticProblem made_;
  PairTruth truth_;
  const ScratchFolder folder_;
};

TEST_F(External, ItsSelectionIsScoredAndRefinedAsThatOfAGrouper) {
  put_text(folder_ / "rows", group_text({100, made_.inliers, {}}));
  const MethodRecord record = evaluate(method("cp " + (folder_ / "rows") + " $group"));
  EXPECT_EQ(record.failure, "");
  EXPECT_EQ(record.method, "mine");
  EXPECT_EQ(record.found.selected, made_.inliers);
  EXPECT_EQ(record.score->precision, 1);
  EXPECT_EQ(record.outcome(), "found");
  EXPECT_GE(record.time_ms.value(), 0);
}

TEST_F(External, ReadsTheTableThatTheProgramsReadAndItsRowsInAnyForm) {
  const std::string last_rows = "grep -vc '^#' $matches | awk '{for (i = $1 - 4; i < $1 - 1; i++) print i}' > $group";
  EXPECT_THAT(evaluate(method(last_rows)).found.selected, ElementsAre(97, 98, 99));
}

TEST_F(External, TakesArraysAsNumpySavesThem) {
  put_text(folder_ / "rows", npy("(3,)", {1, 2, 5}));
  put_text(folder_ / "none", npy("(0,)", {}));
  EXPECT_THAT(evaluate(method("cp " + (folder_ / "rows") + " $group.npy")).found.selected, ElementsAre(1, 2, 5))
      << "by a name";
  EXPECT_THAT(evaluate(method("cp " + (folder_ / "rows") + " $group")).found.selected, ElementsAre(1, 2, 5))
      << "into a file";
  const MethodRecord none = evaluate(method("cp " + (folder_ / "none") + " $group.npy"));
  EXPECT_EQ(none.failure, "");
  EXPECT_THAT(none.found.selected, ::testing::IsEmpty());
}

TEST_F(External, AnEmptyFileOfAProgramThatEndedWellSelectsNothing) {
  const MethodRecord record = evaluate(method(": > $group"));
  EXPECT_EQ(record.failure, "");
  EXPECT_THAT(record.found.selected, ::testing::IsEmpty());
  EXPECT_THAT(failure(": > $group; exit 1"), HasSubstr("ended with status 1"));
  EXPECT_THAT(failure("echo ' ' > $group"), HasSubstr("mine: {group}")) << "as good as nothing, but not empty";
}

TEST_F(External, APoseAloneSelectsWhatItExplains) {
  put_text(folder_ / "truth", transform_text(made_.truth));
  const MethodRecord record = evaluate(method("cp " + (folder_ / "truth") + " $2", "{matches} {pose}"));
  EXPECT_EQ(record.failure, "");
  EXPECT_EQ(record.score->recall, 1);
  EXPECT_TRUE(record.found.target_from_source.has_value());
}

TEST_F(External, EveryWrongAnswerIsItsOwnFailure) {
  EXPECT_EQ(failure("exit 3"), "mine: ended with status 3");
  EXPECT_EQ(failure("kill -SEGV $$"), "mine: ended by signal 11 (status 139)");
  EXPECT_EQ(failure("exit 139"), "mine: ended by signal 11 (status 139)") << "as a shell says it";
  EXPECT_EQ(failure("true"), "mine: wrote no file {group}");
  EXPECT_THAT(failure("echo 100 > $group"), AllOf(HasSubstr("{group}"), HasSubstr("100"), Not(HasSubstr("/corral_"))));
  EXPECT_THAT(failure("printf '0\\n1\\n0\\n' > $group"), HasSubstr("mine: {group}"));
  EXPECT_THAT(failure("echo half a > $group"), HasSubstr("mine: {group}"));
  EXPECT_THAT(failure("echo 1 > $group; echo no > $pose"), HasSubstr("mine: {pose}"));
  EXPECT_EQ(failure("echo out of ideas, see $matches >&2; exit 1"),
            "mine: ended with status 1; it said: out of ideas, see {matches}");
}

TEST_F(External, IsKilledAtItsLimits) {
  ExternalMethod asleep = method("[ $(wc -l < $matches) -lt 9 ] || sleep 60");
  asleep.timeout_s = 0.3;
  EXPECT_THAT(evaluate(asleep).failure, HasSubstr("killed after 0.3 s (--external-timeout)"));
  ExternalMethod endless = method("yes");
  endless.timeout_s = 0.2;
  EXPECT_THAT(evaluate(endless).failure, AllOf(HasSubstr("killed after 0.2 s"), HasSubstr("it said: ")));
}

TEST_F(External, StartUpIsNoPartOfItsTime) {
  const MethodRecord record =
      evaluate(method("sleep 0.4; [ $(wc -l < $matches) -lt 9 ] || sleep 0.4; echo 1 > $group"));
  EXPECT_GT(record.time_ms.value(), 200);
  EXPECT_LT(record.time_ms.value(), 700) << "the call takes 800 ms";
}

TEST_F(External, LeavesNoFilesBehind) {
  const std::string seen = folder_ / "seen";
  evaluate(method("dirname $matches >> " + seen + "; echo 1 > $group"));
  std::istringstream folders(text_of(seen));
  int calls = 0;
  for (std::string folder; std::getline(folders, folder); ++calls) EXPECT_FALSE(std::filesystem::exists(folder));
  EXPECT_EQ(calls, 2) << "one to start, and the call";
}

TEST_F(External, ResultsDependOnTheFilesThatTheCommandNames) {
  EXPECT_THAT(method("true").files(), ElementsAre(folder_ / "mine.sh"));
}

TEST(ParseExternal, SaysWhatIsExpected) {
  EXPECT_EQ(parse_external("mine=a b=c {matches} {group}").command, "a b=c {matches} {group}");
  EXPECT_THAT(parse_error("python3 mine.py {matches} {group}"), HasSubstr("NAME='COMMAND {matches} {group}'"));
  EXPECT_THAT(parse_error("gc=x {matches} {group}"), HasSubstr("no name of a grouper"));
  EXPECT_THAT(parse_error("a/b=x {matches} {group}"), HasSubstr("letters, digits"));
  EXPECT_THAT(parse_error("oracle=x {matches} {group}"), HasSubstr("name is 'oracle'"));
  EXPECT_THAT(parse_error("mine="), HasSubstr("{matches}"));
  EXPECT_THAT(parse_error("mine=x {matches}"), HasSubstr("{group}, {pose} or both"));
  EXPECT_THAT(parse_error("mine=x {group}"), HasSubstr("{matches}"));
  EXPECT_THAT(parse_error("mine='x {matches} {group}"), HasSubstr("quotation"));
}

}  // namespace
}  // namespace corral
