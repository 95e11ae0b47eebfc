// SPDX-License-Identifier: MIT
#include "io/disk/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/io/scratch.h"

namespace corral {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::io_error_of;
using ::testing::IsEmpty;
using testing::put_text;
using testing::ScratchFolder;
using ::testing::StartsWith;
using testing::text_of;

mode_t mode_of(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
}

/// Sets the file mode mask for a while.
class Umask {
 public:
  explicit Umask(mode_t mask) : before_(::umask(mask)) {}
  ~Umask() { ::umask(before_); }
  Umask(const Umask&) = delete;
  Umask& operator=(const Umask&) = delete;

 private:
  mode_t before_;
};

TEST(ReadFile, GivesEveryByte) {
  const ScratchFolder folder;
  std::string content;
  for (int i = 0; i < 200000; ++i) content += static_cast<char>(i % 256);
  EXPECT_EQ(read_file(put_text(folder / "bytes", content)), content);
  EXPECT_EQ(read_file(put_text(folder / "none", "")), "");
  for (int i = 0; i < 5; ++i) content += content;  // several large pages
  EXPECT_EQ(read_file(put_text(folder / "large", content)), content);
}

TEST(ReadFile, NamesWhatIsMissing) {
  const ScratchFolder folder;
  const std::string path = folder / "missing.ply";
  EXPECT_EQ(io_error_of([&] { read_file(path); }), path + ": does not exist");
  const std::string below_a_file = put_text(folder / "plain", "x") + "/below";
  EXPECT_EQ(io_error_of([&] { read_file(below_a_file); }), below_a_file + ": does not exist");
}

TEST(ReadFile, RefusesAFolderAndADevice) {
  const ScratchFolder folder;
  EXPECT_EQ(io_error_of([&] { read_file(folder.path()); }), folder.path() + ": is a directory, expected a file");
  EXPECT_EQ(io_error_of([] { read_file("/dev/zero"); }), "/dev/zero: is a device, expected a file");
  EXPECT_EQ(io_error_of([] { read_file("/dev/null"); }), "/dev/null: is a device, expected a file");
}

TEST(ReadFile, ReadsAPipe) {
  const ScratchFolder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const std::string content(100000, 'p');
  std::thread writer([&] { put_text(path, content); });
  EXPECT_EQ(read_file(path), content);
  writer.join();
}

// The first page of a process's memory cannot be read, although the file that shows it can be opened.
TEST(ReadFile, NamesAFileThatCannotBeRead) {
  EXPECT_THAT(io_error_of([] { read_file("/proc/self/mem"); }), StartsWith("/proc/self/mem: cannot be read"));
}

TEST(WriteFile, WritesEveryByteAndLeavesNothingElse) {
  const ScratchFolder folder;
  const std::string path = folder / "out", content("a\0b\r\n\xff", 6);
  write_file(path, content);
  EXPECT_EQ(text_of(path), content);
  write_file(path, "");
  EXPECT_EQ(text_of(path), "");
  EXPECT_THAT(folder.names(), ElementsAre("out"));
}

TEST(WriteFile, ReplacesAnExistingFileByANewOne) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "out", "old"), other_name = folder / "other_name";
  fs::create_hard_link(path, other_name);
  write_file(path, "new");
  EXPECT_EQ(text_of(path), "new");
  EXPECT_EQ(text_of(other_name), "old") << "whoever holds the old file keeps it whole";
}

TEST(WriteFile, NamesAFolderThatDoesNotExist) {
  const ScratchFolder folder;
  const std::string path = folder / "nowhere/out.csv";
  EXPECT_THAT(io_error_of([&] { write_file(path, "x"); }),
              AllOf(StartsWith(path + ": "), HasSubstr("cannot be created"), HasSubstr("No such file")));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(WriteFile, RefusesAFolder) {
  const ScratchFolder folder;
  const std::string path = folder / "taken";
  fs::create_directory(path);
  EXPECT_EQ(io_error_of([&] { write_file(path, "x"); }), path + ": is a directory, expected a file to write");
  EXPECT_THAT(folder.names(), ElementsAre("taken"));
}

// /dev/full takes no byte. The write fails as on a full disk.
TEST(WriteFile, SaysThatTheDiskIsFull) {
  EXPECT_EQ(io_error_of([] { write_file("/dev/full", "x"); }),
            "/dev/full: cannot be written (No space left on device)");
}

TEST(WriteFile, WhatWasThereStaysIfWritingFails) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "out", "old");
  rlimit limit;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit tiny{4, limit.rlim_max};  // bytes that a file may have from now on
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tiny), 0);
  const std::string error = io_error_of([&] { write_file(path, "longer than that"); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(error, path + ": cannot be written (File too large)");
  EXPECT_EQ(text_of(path), "old");
  EXPECT_THAT(folder.names(), ElementsAre("out"));
}

TEST(WriteFile, ALinkStaysALink) {
  const ScratchFolder folder;
  fs::create_directory(folder / "elsewhere");
  const std::string place = put_text(folder / "elsewhere/file", "old"), link = folder / "link";
  fs::create_symlink("elsewhere/file", link);
  write_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_FALSE(fs::is_symlink(place));
  EXPECT_EQ(text_of(place), "new");
  EXPECT_THAT(folder.names(), ElementsAre("elsewhere", "link"));
}

TEST(WriteFile, ALinkToAFileThatIsNotThereYetStaysALink) {
  const ScratchFolder folder;
  const std::string link = folder / "link";
  fs::create_symlink("later", link);
  write_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(text_of(folder / "later"), "new");
}

TEST(WriteFile, PermissionsFollowTheUmask) {
  const ScratchFolder folder;
  for (const mode_t mask : {022U, 077U, 0U}) {
    const Umask masked(mask);
    const std::string path = folder / ("mask" + std::to_string(mask));
    write_file(path, "x");
    EXPECT_EQ(mode_of(path), 0666U & ~mask);
    EXPECT_EQ(::umask(mask), mask) << "the mask itself is left as it was";
  }
}

TEST(WriteFile, WritesToADeviceAndAPipe) {
  write_file("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const ScratchFolder folder;
  const std::string path = folder / "pipe", content(100000, 'p');
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::string seen;
  std::thread reader([&] { seen = text_of(path); });
  write_file(path, content);
  reader.join();
  EXPECT_EQ(seen, content);
  EXPECT_TRUE(fs::is_fifo(path));
}

TEST(RemoveFile, TakesAwayAFileAndNothingElse) {
  const ScratchFolder folder;
  const std::string path = put_text(folder / "out", "x"), kept = folder / "kept";
  fs::create_directory(kept);
  for (int twice = 0; twice < 2; ++twice) remove_file(path);
  remove_file(kept);
  remove_file("/dev/null");
  EXPECT_THAT(folder.names(), ElementsAre("kept"));
  EXPECT_TRUE(fs::exists("/dev/null"));
}

TEST(MakeFolder, MakesParentsAndAcceptsWhatIsThere) {
  const ScratchFolder folder;
  for (int twice = 0; twice < 2; ++twice) make_folder(folder / "a/b/c");
  EXPECT_TRUE(fs::is_directory(folder / "a/b/c"));
}

TEST(MakeFolder, NamesAFileInTheWay) {
  const ScratchFolder folder;
  const std::string taken = put_text(folder / "taken", "x");
  EXPECT_THAT(io_error_of([&] { make_folder(taken); }),
              AllOf(StartsWith(taken + ": cannot be created as a folder"), ::testing::Not(HasSubstr("Success"))));
  EXPECT_THAT(io_error_of([&] { make_folder(taken + "/below"); }),
              AllOf(StartsWith(taken), HasSubstr("Not a directory")));
  EXPECT_EQ(text_of(taken), "x");
}

TEST(WriteFile, KeepsThePermissionsOfWhatWasThere) {
  const ScratchFolder folder;
  put_text(folder / "secret", "old");
  fs::permissions(folder / "secret", fs::perms::owner_read | fs::perms::owner_write);
  write_file(folder / "secret", "new");
  EXPECT_EQ(fs::status(folder / "secret").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(WriteFiles, AllOrNone) {
  const ScratchFolder folder;
  EXPECT_THROW(write_files({{folder / "a", "1"}, {folder / "nowhere/b", "2"}}), IoError);
  EXPECT_TRUE(folder.names().empty());
  write_files({{folder / "a", "1"}, {folder / "b", "2"}});
  EXPECT_EQ(folder.names().size(), 2U);
}

TEST(CheckWritable, SaysWhatWritingWouldAndChangesNothing) {
  const ScratchFolder folder;
  put_text(folder / "there", "old");
  EXPECT_NO_THROW(check_writable(folder / "there"));
  EXPECT_NO_THROW(check_writable(folder / "new"));
  EXPECT_THROW(check_writable(folder / "nowhere/new"), IoError);
  EXPECT_THROW(check_writable(folder / "."), IoError);
  EXPECT_EQ(read_file(folder / "there"), "old");
  EXPECT_EQ(folder.names().size(), 1U);
}

TEST(WriteFiles, EachHasAPlaceOfItsOwn) {
  const ScratchFolder folder;
  EXPECT_THAT(io_error_of([&] {
                write_files({{folder / "a", "1"}, {folder / "./a", "2"}});
              }),
              HasSubstr("named for two outputs"));
  EXPECT_TRUE(folder.names().empty());
  make_folder(folder / "below");
  fs::create_symlink("below", folder / "other");
  fs::create_symlink("below/a", folder / "link");
  for (const char* name : {"other/a", "link"})
    EXPECT_THAT(io_error_of([&] {
                  write_files({{folder / "below/a", "1"}, {folder / name, "2"}});
                }),
                HasSubstr("named for two outputs"));
  EXPECT_TRUE(fs::is_empty(folder / "below"));
  write_files({{folder / "below/a", "1"}, {folder / "a", "2"}, {"/dev/null", "3"}, {"/dev/null", "4"}});
}

TEST(RemoveLeftovers, TakesAwayWhatAKilledWriteLeft) {
  const ScratchFolder folder;
  make_folder(folder / "below");
  for (const char* name : {"a.ply.part-Xy12zZ", "below/b.xf.part-000000"}) put_text(folder / name, "half");
  const std::vector<std::string> others = {"a.ply", "pairs.csv.backup", "b.part-123456.ply", "c.ply.part-1"};
  for (const std::string& name : others) put_text(folder / name, "whole");
  remove_leftovers(folder.path());
  EXPECT_EQ(folder.names().size(), others.size() + 1);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "below"));
  for (const std::string& name : others) EXPECT_EQ(read_file(folder / name), "whole");
  fs::create_symlink("nowhere", folder / "link");
  remove_leftovers(folder.path());
  EXPECT_TRUE(fs::is_symlink(folder / "link")) << "a link to nothing stops nothing";
  EXPECT_THAT(io_error_of([&] { remove_leftovers(folder / "none"); }), StartsWith(folder / "none: cannot be read"));
}

TEST(RemoveLeftovers, KnowsTheNamesThatWritesUse) {
  const ScratchFolder folder;
  // A child that is killed by the limit on the size of a file, in the middle of a write.
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit none{0, 0}, small{1000, 1000};
    ::setrlimit(RLIMIT_CORE, &none);
    ::setrlimit(RLIMIT_FSIZE, &small);
    ::signal(SIGXFSZ, SIG_DFL);
    write_file(folder / "x.ply", std::string(5000, 'x'));
    ::_exit(0);
  }
  int ended = 0;
  ASSERT_EQ(::waitpid(child, &ended, 0), child);
  ASSERT_TRUE(WIFSIGNALED(ended));
  ASSERT_EQ(folder.names().size(), 1U);
  remove_leftovers(folder.path());
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace corral
