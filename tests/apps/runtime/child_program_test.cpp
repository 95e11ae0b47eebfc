// SPDX-License-Identifier: MIT
#include "apps/runtime/child_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/io/scratch.h"

namespace corral {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::io_error_of;
using ::testing::IsEmpty;
using testing::ScratchFolder;
using ::testing::SizeIs;
using testing::text_of;

ChildEnd shell(const std::string& script, double seconds = 30, std::uint64_t memory = 0) {
  return run_child({"/bin/sh", "-c", script}, {seconds, memory});
}

TEST(RunChild, SaysHowTheProgramEndedAndWhatItSaidLast) {
  const ChildEnd end = shell("echo out; echo err >&2; exit 7");
  EXPECT_EQ(end.status, 7);
  EXPECT_FALSE(end.is_timeout);
  EXPECT_EQ(end.messages, "out\nerr\n");
  EXPECT_GT(end.milliseconds, 0);
  EXPECT_EQ(shell("kill -SEGV $$").status, 128 + 11);
  EXPECT_EQ(shell("exec true").status, 0);
}

TEST(RunChild, WordsReachTheProgramAsTheyAre) {
  const ChildEnd end = run_child({"/usr/bin/printf", "[%s]", "a b", "$HOME", "*", "'", ""}, {});
  EXPECT_EQ(end.messages, "[a b][$HOME][*]['][]");
}

TEST(RunChild, KeepsTheEndOfMuchOutput) {
  const ChildEnd end = shell("i=0; while [ $i -lt 3000 ]; do echo 'some words on a line'; i=$((i+1)); done; echo last");
  EXPECT_EQ(end.status, 0);
  EXPECT_THAT(end.messages, SizeIs(kChildMessages));
  EXPECT_THAT(end.messages, EndsWith("line\nlast\n"));
}

TEST(RunChild, KillsAtTheLimitOfTimeWhateverTheProgramStarted) {
  const ScratchFolder folder;
  const ChildEnd asleep = shell("sleep 60", 0.2);
  EXPECT_TRUE(asleep.is_timeout);
  EXPECT_LT(asleep.milliseconds, 20'000);
  EXPECT_TRUE(shell("yes", 0.2).is_timeout) << "prints without end";
  const std::string late = folder / "late";
  EXPECT_TRUE(shell("(sleep 0.6; echo x > " + late + ") & sleep 60", 0.2).is_timeout);
  const ChildEnd forked = shell("(sleep 0.6; echo x > " + late + ") & exit 0");
  EXPECT_EQ(forked.status, 0);
  EXPECT_LT(forked.milliseconds, 500) << "it does not wait for what was left running";
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  EXPECT_THAT(folder.names(), IsEmpty()) << "and that is killed";
}

TEST(RunChild, HasNoMoreMemoryThanItMay) {
  const std::string take = "dd if=/dev/zero of=/dev/null bs=100M count=1";  // in a buffer of that size
  EXPECT_NE(shell(take, 30, 64 << 20).status, 0);
  EXPECT_EQ(shell(take).status, 0);
}

TEST(RunChild, NamesAProgramThatCannotBeStarted) {
  EXPECT_THAT(io_error_of([] { run_child({"no-such-program"}, {}); }), HasSubstr("no-such-program"));
  EXPECT_THAT(io_error_of([] { run_child({"/etc/passwd"}, {}); }), HasSubstr("cannot be started: Permission denied"));
}

TEST(SplitWords, SeparatesAsAShellDoes) {
  EXPECT_THAT(split_words("  python3\tmine.py  {matches} "), ElementsAre("python3", "mine.py", "{matches}"));
  EXPECT_THAT(split_words("a'b c'd \"e \\\" f\" g\\ h '' 'x\\y' \"\\z\""),
              ElementsAre("ab cd", "e \" f", "g h", "", "x\\y", "\\z"));
  EXPECT_THAT(split_words("$HOME * ; | > x"), ElementsAre("$HOME", "*", ";", "|", ">", "x")) << "nothing is special";
  EXPECT_THAT(split_words(" \t"), IsEmpty());
  EXPECT_THROW(split_words("a 'b"), InvalidInput);
}

TEST(ShellWord, IsOneWordForAShell) {
  for (const std::string word : {"a b", "it's", "$HOME", "", "a\"b\\c", "*"})
    EXPECT_THAT(split_words(shell_word(word)), ElementsAre(word));
  EXPECT_EQ(shell_word("/data/b3r_1.5:x=+,"), "/data/b3r_1.5:x=+,") << "is read more easily";
}

}  // namespace
}  // namespace corral
