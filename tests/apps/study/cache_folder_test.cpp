// SPDX-License-Identifier: MIT
#include "apps/study/cache_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "apps/study/content_store.h"
#include "io/disk/file.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using testing::io_error_of;
using testing::put_text;
using testing::ScratchFolder;
using ::testing::StartsWith;
using testing::text_of;

std::string key(int number) { return content_hash(std::to_string(number)); }

/// The time of last use, so many hours before now.
void age(const std::string& path, int hours) {
  fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(hours));
}

std::uint64_t bytes_in(const std::string& folder) {
  std::uint64_t bytes = 0;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::uintmax_t size = entry.file_size(gone);
    if (!gone) bytes += size;
  }
  return bytes;
}

TEST(CacheFolder, GivesBackWhatWasSaved) {
  const ScratchFolder folder;
  const CacheFolder cache(folder / "a/b", 0);
  EXPECT_FALSE(cache.load(key(1)));
  cache.save(key(1), std::string("x\0y", 3));
  EXPECT_EQ(cache.load(key(1)), std::string("x\0y", 3));
  EXPECT_EQ(CacheFolder(folder / "a/b", 1000).load(key(1)), std::string("x\0y", 3));
  EXPECT_THROW(CacheFolder(put_text(folder / "file", "x"), 0), IoError);
}

TEST(CacheFolder, DeletesWhatWasUsedLongestAgo) {
  const ScratchFolder folder;
  const CacheFolder cache(folder.path(), 1000);
  for (int i = 1; i <= 5; ++i) {
    cache.save(key(i), std::string(150, 'x'));
    age(folder / key(i), 10 - i);
  }
  EXPECT_TRUE(cache.load(key(1)));  // used now
  const CacheFolder other(folder.path(), 1000);
  other.save(key(6), std::string(400, 'y'));  // 150 too many
  EXPECT_TRUE(other.load(key(1)));
  EXPECT_FALSE(other.load(key(2)));
  for (int i = 3; i <= 6; ++i) EXPECT_TRUE(other.load(key(i))) << i;
}

TEST(CacheFolder, EqualTimesGoByName) {
  const ScratchFolder folder;
  const auto same = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (int i = 0; i < 7; ++i) fs::last_write_time(put_text(folder / key(i), std::string(100, 'x')), same);
  std::vector<std::string> expected = folder.names();
  expected.erase(expected.begin(), expected.begin() + 2);
  const std::string added = key(7);
  CacheFolder(folder.path(), 800).save(added, std::string(300, 'x'));
  expected.insert(std::lower_bound(expected.begin(), expected.end(), added), added);
  EXPECT_EQ(folder.names(), expected);
}

TEST(CacheFolder, NeverHoldsMoreThanTheLimit) {
  const ScratchFolder folder;
  const CacheFolder cache(folder.path(), 10000);
  for (int i = 0; i < 100; ++i) {
    const std::string content(static_cast<std::size_t>(i * 137 % 2000), 'x');
    cache.save(key(i), content);
    EXPECT_LE(bytes_in(folder.path()), 10000U);
    EXPECT_EQ(cache.load(key(i)), content) << "what was saved last stays";
  }
  EXPECT_GT(bytes_in(folder.path()), 6000U) << "room that is allowed is used";
  cache.save(key(1000), std::string(10001, 'x'));
  EXPECT_FALSE(cache.load(key(1000))) << "too large for any room";
  cache.save(key(1001), std::string(10000, 'x'));
  EXPECT_EQ(folder.names(), std::vector<std::string>{key(1001)}) << "exactly as large";
}

TEST(CacheFolder, WithoutALimitNothingIsDeleted) {
  const ScratchFolder folder;
  const CacheFolder cache(folder.path(), 0);
  for (int i = 0; i < 10; ++i) cache.save(key(i), std::string(1000, 'x'));
  EXPECT_EQ(folder.names().size(), 10U);
}

TEST(CacheFolder, WhatIsNotItsOwnStays) {
  const ScratchFolder folder;
  const std::vector<std::string> others = {"notes.txt", key(1) + ".png", key(2).substr(1), "x.part-123456",
                                           "A" + key(3).substr(1)};
  for (const std::string& name : others) age(put_text(folder / name, std::string(5000, 'x')), 100);
  fs::create_directory(folder / key(4));
  put_text(folder / key(4) + "/" + key(5), "inside");
  fs::create_symlink("notes.txt", folder / key(6));
  const CacheFolder cache(folder.path(), 1000);
  for (int i = 10; i < 30; ++i) cache.save(key(i), std::string(300, 'y'));
  EXPECT_TRUE(cache.load(key(29))) << "foreign files take no room";
  for (const std::string& name : others) EXPECT_EQ(text_of(folder / name).size(), 5000U) << name;
  EXPECT_EQ(text_of(folder / key(4) + "/" + key(5)), "inside");
  EXPECT_TRUE(fs::is_symlink(folder / key(6)));
}

TEST(CacheFolder, UnfinishedFilesGoWhenNobodyCanBeWritingThem) {
  const ScratchFolder folder;
  const std::string fresh = key(1) + ".part-Abc123", old = key(2) + ".part-Abc123";
  for (const std::string& name : {fresh, old}) put_text(folder / name, std::string(400, 'x'));
  age(folder / fresh, 20);
  age(folder / old, 30);
  const CacheFolder cache(folder.path(), 1000);
  EXPECT_THAT(folder.names(), ElementsAre(fresh));
  for (int i = 10; i < 30; ++i) cache.save(key(i), std::string(200, 'x'));
  EXPECT_TRUE(fs::exists(folder / fresh)) << "somebody may be writing it";
  EXPECT_LE(bytes_in(folder.path()), 1000U) << "but it takes room";
}

// What is being written takes room before it is there.
TEST(CacheFolder, ThreadsTogetherKeepToTheLimit) {
  const ScratchFolder folder;
  const CacheFolder cache(folder.path(), 8000);
  std::vector<std::thread> threads;
  std::vector<std::uint64_t> most(6);
  for (std::size_t i = 0; i < most.size(); ++i)
    threads.emplace_back([&, i] {
      for (int round = 0; round < 12; ++round) {
        cache.save(key(100 * round + static_cast<int>(i)), std::string(2000, 'x'));
        most[i] = std::max(most[i], bytes_in(folder.path()));
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(most, ::testing::Each(::testing::Le(8000U)));
}

/// Saves and loads as a study does; whether every file that was loaded was whole.
bool use(const CacheFolder& cache, int seed) {
  bool is_whole = true;
  for (int i = 0; i < 80; ++i) {
    const int number = (seed + i * 7) % 30;
    const std::string content(static_cast<std::size_t>(300 + 20 * number), static_cast<char>('a' + number % 26));
    if (const auto found = cache.load(key(number)))
      is_whole = is_whole && *found == content;
    else
      cache.save(key(number), content);
  }
  return is_whole;
}

TEST(CacheFolder, TwoStoresInThreadsShareAFolder) {
  const ScratchFolder folder;
  const CacheFolder first(folder.path(), 8000), second(folder.path(), 8000);
  std::vector<std::thread> threads;
  std::vector<char> is_whole(6);
  for (int i = 0; i < 6; ++i)
    threads.emplace_back([&, i] { is_whole[static_cast<std::size_t>(i)] = use(i % 2 == 0 ? first : second, 11 * i); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(is_whole, ::testing::Each(true));
  EXPECT_LE(bytes_in(folder.path()), 8000U + 8000U / 8 + 1100U);  // one file of the other beyond its eighth
  for (const std::string& name : folder.names()) EXPECT_EQ(name.size(), 32U) << "nothing unfinished";
}

TEST(CacheFolder, TwoProcessesShareAFolder) {
  const ScratchFolder folder;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(use(CacheFolder(folder.path(), 8000), 3) ? 0 : 1);
  EXPECT_TRUE(use(CacheFolder(folder.path(), 8000), 0));
  int ended = 1;
  ASSERT_EQ(::waitpid(child, &ended, 0), child);
  EXPECT_EQ(ended, 0);
  EXPECT_LE(bytes_in(folder.path()), 8000U + 8000U / 8 + 1100U);
  for (const std::string& name : folder.names()) EXPECT_EQ(name.size(), 32U);
}

// A file that another process deletes between two calls.
TEST(CacheFolder, AFileThatIsGoneIsAbsent) {
  const ScratchFolder folder;
  const CacheFolder cache(folder.path(), 1000);
  cache.save(key(1), "x");
  fs::remove(folder / key(1));
  EXPECT_FALSE(cache.load(key(1)));
  fs::remove_all(folder.path());
  cache.save(key(1), std::string(500, 'x'));
  cache.save(key(2), std::string(500, 'x'));
  EXPECT_FALSE(cache.load(key(1)));
}

/// Runs as a user whom permissions bind, if the caller is root; whether the call returned true there.
template <class Call>
bool as_other_user(const std::string& folder, const Call& call) {
  fs::permissions(folder, fs::perms::all);
  const pid_t child = ::fork();
  if (child == 0) {
    if (::geteuid() == 0 && ::setuid(65534) != 0) ::_exit(2);
    ::_exit(call() ? 0 : 1);
  }
  int ended = 1;
  return ::waitpid(child, &ended, 0) == child && ended == 0;
}

TEST(CacheFolder, AFolderThatBecomesReadOnlyStillGives) {
  const ScratchFolder folder;
  EXPECT_TRUE(as_other_user(folder.path(), [&] {
    const CacheFolder cache(folder / "cache", 1000);
    for (int i = 0; i < 5; ++i) cache.save(key(i), std::string(200, 'x'));
    fs::permissions(folder / "cache", fs::perms::owner_read | fs::perms::owner_exec);
    for (int i = 5; i < 50; ++i) cache.save(key(i), std::string(200, 'x'));
    const CacheFolder again(folder / "cache", 1000);
    again.save(key(60), std::string(900, 'x'));
    const bool is_as_expected =
        cache.load(key(4)) && again.load(key(4)) && !cache.load(key(49)) && !again.load(key(60));
    fs::permissions(folder / "cache", fs::perms::owner_all);
    return is_as_expected;
  }));
}

}  // namespace
}  // namespace corral
