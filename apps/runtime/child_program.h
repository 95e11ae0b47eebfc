// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace corral {

/// What a program may take.
struct ChildLimits {
  double seconds = 60;             ///< wall time, then it is killed with all processes of its group
  std::uint64_t memory_bytes = 0;  ///< address space of each of its processes; 0: no limit
};

/// How a program ended.
struct ChildEnd {
  int status = 0;           ///< its exit status, or 128 + the signal that ended it
  bool is_timeout = false;  ///< it was killed at its limit of time
  double milliseconds = 0;  ///< wall time from its start to its end
  std::string
      messages;  ///< the end of what it wrote to standard output and standard error, kChildMessages bytes at most
};

constexpr std::size_t kChildMessages = 4096;           ///< bytes of its messages that are kept
constexpr std::uint64_t kChildFileBytes = 1ull << 30;  ///< largest file that it may write

/// Runs a program, looked for in PATH, without a shell, with empty standard input, and waits for its end. Whatever its process
/// group still runs then is killed, and so is it when this program dies. Output is read and dropped but for its end.
/// Throws    IoError naming the program if it cannot be started.
ChildEnd run_child(const std::vector<std::string>& words, const ChildLimits& limits);

/// The words of a command as a shell would separate them: by blanks, with '..', ".." and backslash; nothing else is special.
/// Throws    InvalidInput for a quotation that does not end.
std::vector<std::string> split_words(const std::string& command);

/// A text as one word of a POSIX shell.
std::string shell_word(const std::string& text);

}  // namespace corral
