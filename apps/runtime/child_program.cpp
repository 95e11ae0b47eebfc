// SPDX-License-Identifier: MIT
#include "apps/runtime/child_program.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "apps/runtime/stopwatch.h"
#include "kernel/error.h"

namespace corral {
namespace {

/// A file descriptor that is closed in the end.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

struct Pipe {
  explicit Pipe(const std::string& program) : Pipe(make(program)) {}
  Descriptor out, in;

 private:
  struct Ends {
    int out, in;
  };
  explicit Pipe(Ends ends) : out(ends.out), in(ends.in) {}
  static Ends make(const std::string& program) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
      throw IoError(program, "", std::string("cannot be started: ") + std::strerror(errno));
    return {ends[0], ends[1]};
  }
};

void limit(int resource, std::uint64_t bytes) {
  const rlimit most{bytes, bytes};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &most);
}

/// In the new process: only calls that are safe between fork and exec of a program with threads.
[[noreturn]] void become(char* const* words, int output, int failure, pid_t parent, const ChildLimits& limits) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it died before that call
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, 0);
  ::dup2(output, 1);
  ::dup2(output, 2);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, kChildFileBytes);
  if (limits.memory_bytes > 0) limit(RLIMIT_AS, limits.memory_bytes);
  ::execvp(words[0], words);
  const int cause = errno;
  [[maybe_unused]] const ssize_t written = ::write(failure, &cause, sizeof cause);
  ::_exit(127);
}

/// Reads what is there, and keeps its end. False when nothing more can come.
bool drain(int from, std::string& kept) {
  char buffer[65536];
  const ssize_t count = ::read(from, buffer, sizeof buffer);
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  kept.append(buffer, static_cast<std::size_t>(count));
  if (kept.size() > kChildMessages) kept.erase(0, kept.size() - kChildMessages);
  return count > 0;
}

/// Waits until the process has ended or its time is over, reading its output meanwhile. Whether it has ended.
bool wait_for(pid_t child, int output, double seconds, std::string& messages) {
  const Descriptor process(static_cast<int>(::syscall(SYS_pidfd_open, child, 0)));
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  bool is_open = true;
  for (;;) {
    const double left = std::chrono::duration<double>(end - std::chrono::steady_clock::now()).count();
    if (!(left > 0)) return false;
    // Without a descriptor of the process, as under some emulators, it is asked every few milliseconds.
    const double wait = std::min(left, process.number() >= 0 ? 3600.0 : 0.005);
    pollfd polled[2] = {{process.number(), POLLIN, 0}, {is_open ? output : -1, POLLIN, 0}};
    ::poll(polled, 2, static_cast<int>(wait * 1000) + 1);
    if (polled[1].revents != 0) is_open = drain(output, messages);
    siginfo_t info{};
    if (::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child)
      return true;
  }
}

}  // namespace

ChildEnd run_child(const std::vector<std::string>& words, const ChildLimits& limits) {
  if (words.empty()) throw InvalidInput("run_child", "command", "''", "the name of a program");
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Pipe output(words[0]), failure(words[0]);
  const pid_t parent = ::getpid();
  Stopwatch watch;
  const pid_t child = ::fork();
  if (child < 0) throw IoError(words[0], "", std::string("cannot be started: ") + std::strerror(errno));
  if (child == 0) become(arguments.data(), output.in.number(), failure.in.number(), parent, limits);
  ::setpgid(child, child);  // whoever comes first
  output.in.close();
  failure.in.close();
  int cause = 0, state = 0;
  if (::read(failure.out.number(), &cause, sizeof cause) == static_cast<ssize_t>(sizeof cause)) {
    ::waitpid(child, &state, 0);
    throw IoError(words[0], "", std::string("cannot be started: ") + std::strerror(cause));
  }
  ChildEnd end;
  end.is_timeout = !wait_for(child, output.out.number(), limits.seconds, end.messages);
  end.milliseconds = watch.lap_ms();
  ::kill(-child, SIGKILL);  // before its number can be that of another process
  while (::waitpid(child, &state, 0) < 0 && errno == EINTR) {
  }
  end.status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  ::fcntl(output.out.number(), F_SETFL, O_NONBLOCK);  // a process that left its group may hold the other end
  for (int i = 0; i < 16 && drain(output.out.number(), end.messages); ++i) {
  }
  return end;
}

std::vector<std::string> split_words(const std::string& command) {
  std::vector<std::string> words;
  std::string word;
  bool is_begun = false;
  char quote = 0;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char letter = command[i];
    const bool is_escaped = letter == '\\' && quote != '\'' && i + 1 < command.size() &&
                            (quote == 0 || command[i + 1] == '"' || command[i + 1] == '\\');
    if (is_escaped) {
      word += command[++i];
      is_begun = true;
    } else if (quote != 0) {
      if (letter == quote)
        quote = 0;
      else
        word += letter;
    } else if (letter == '\'' || letter == '"') {
      quote = letter;
      is_begun = true;
    } else if (letter == ' ' || letter == '\t' || letter == '\n') {
      if (is_begun) words.push_back(word);
      word.clear();
      is_begun = false;
    } else {
      word += letter;
      is_begun = true;
    }
  }
  if (quote != 0) throw InvalidInput("command", "quotation", std::string(1, quote), "one that ends");
  if (is_begun) words.push_back(word);
  return words;
}

std::string shell_word(const std::string& text) {
  constexpr auto kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./=,:+";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char letter : text) word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return word + "'";
}

}  // namespace corral
