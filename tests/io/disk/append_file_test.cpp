// SPDX-License-Identifier: MIT
#include "io/disk/append_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "tests/io/scratch.h"

namespace corral {
namespace {

namespace fs = std::filesystem;
using testing::io_error_of;
using testing::put_text;
using testing::ScratchFolder;
using ::testing::StartsWith;
using testing::text_of;

TEST(AppendFile, HasEveryLineAtOnce) {
  const ScratchFolder folder;
  auto file = AppendFile::create(folder / "journal");
  ASSERT_TRUE(file);
  EXPECT_EQ(file->path(), folder / "journal");
  EXPECT_EQ(text_of(folder / "journal"), "");
  file->append("first\n");
  EXPECT_EQ(text_of(folder / "journal"), "first\n");
  AppendFile moved = std::move(*file);
  moved.append("second\n");
  EXPECT_EQ(text_of(folder / "journal"), "first\nsecond\n");
}

TEST(AppendFile, IsAbsentWhereTheNameIsTaken) {
  const ScratchFolder folder;
  put_text(folder / "file", "old");
  fs::create_directory(folder / "folder");
  fs::create_symlink("nowhere", folder / "link");
  for (const char* name : {"file", "folder", "link"}) EXPECT_FALSE(AppendFile::create(folder / name)) << name;
  EXPECT_EQ(text_of(folder / "file"), "old");
  EXPECT_FALSE(fs::exists(folder / "nowhere"));
}

TEST(AppendFile, NamesWhatCannotBeCreated) {
  const ScratchFolder folder;
  const std::string path = folder / "nowhere/journal";
  EXPECT_EQ(io_error_of([&] { AppendFile::create(path); }), path + ": cannot be created (No such file or directory)");
}

TEST(AppendFile, OneOfTwoProcessesGetsAName) {
  const ScratchFolder folder;
  constexpr int kNames = 60;
  const auto create_all = [&](const std::string& mark) {
    int got = 0;
    for (int i = 0; i < kNames; ++i)
      if (auto file = AppendFile::create(folder / std::to_string(i))) file->append(mark), ++got;
    return got;
  };
  const pid_t child = ::fork();
  if (child == 0) {
    put_text(folder / "child", std::to_string(create_all("c")));
    ::_exit(0);
  }
  const int ours = create_all("p");
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(ours + std::stoi(text_of(folder / "child")), kNames);
  int marked = 0;
  for (int i = 0; i < kNames; ++i) {
    const std::string text = text_of(folder / std::to_string(i));
    EXPECT_TRUE(text == "c" || text == "p") << text;
    marked += text == "p";
  }
  EXPECT_EQ(marked, ours);
}

/// Bytes that a file may have, for a while; a write beyond fails, or is cut to a part.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SizeLimit(const SizeLimit&) = delete;
  SizeLimit& operator=(const SizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(AppendFile, ALineThatDoesNotFitLeavesNothing) {
  const ScratchFolder folder;
  auto file = AppendFile::create(folder / "journal");
  ASSERT_TRUE(file);
  file->append("12345\n");
  {
    const SizeLimit limit(10);
    for (int twice = 0; twice < 2; ++twice) {
      EXPECT_EQ(io_error_of([&] { file->append("67890\n"); }), file->path() + ": cannot be written (File too large)");
      EXPECT_EQ(text_of(folder / "journal"), "12345\n");
    }
  }
  file->append("again\n");
  EXPECT_EQ(text_of(folder / "journal"), "12345\nagain\n");
}

// Behind a descriptor whose file can neither be written nor cut, there is something that nobody knows.
TEST(AppendFile, NothingIsAddedBehindWhatCouldNotBeUndone) {
  const ScratchFolder folder;
  const int number = ::dup(STDIN_FILENO);  // that of the next file
  ::close(number);
  auto file = AppendFile::create(folder / "journal");
  ASSERT_TRUE(file);
  file->append("first\n");
  const int whole = ::dup(number), full = ::open("/dev/full", O_WRONLY);
  ASSERT_EQ(::dup2(full, number), number);
  EXPECT_EQ(io_error_of([&] { file->append("second\n"); }),
            file->path() + ": cannot be written (No space left on device)");
  ASSERT_EQ(::dup2(whole, number), number);
  EXPECT_THAT(io_error_of([&] { file->append("third\n"); }),
              StartsWith(file->path() + ", byte 6: cannot be appended to"));
  EXPECT_EQ(text_of(folder / "journal"), "first\n");
  ::close(whole), ::close(full);
}

}  // namespace
}  // namespace corral
