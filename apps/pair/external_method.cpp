// SPDX-License-Identifier: MIT
#include "apps/pair/external_method.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <new>

#include "apps/pair/foreign_answer.h"
#include "apps/pair/methods.h"
#include "apps/runtime/child_program.h"
#include "apps/runtime/temporary_folder.h"
#include "io/array/npy_file.h"
#include "io/disk/file.h"
#include "io/matches/matches_file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// The files of a call by what stands for them in its command.
using CallFiles = std::vector<std::pair<std::string, std::string>>;

CallFiles files_in(const TemporaryFolder& folder) {
  return {{"{matches}", folder / "matches.csv"}, {"{group}", folder / "group.csv"}, {"{pose}", folder / "pose.txt"}};
}

bool names_file(const ExternalMethod& method, const std::string& name) {
  return method.command.find(name) != std::string::npos;
}

ChildEnd call(const ExternalMethod& method, const CorrespondenceSet& matches, const CallFiles& files) {
  write_file(files[0].second, matches_text(matches));
  std::vector<std::string> words = split_words(method.command);
  for (std::string& word : words)
    for (const auto& [name, file] : files) replace_all(word, name, file);
  return run_child(words, {method.timeout_s, method.memory_bytes});
}

/// Without control characters, in one line, with the names of the command for the files of the call, which differ from call to
/// call.
std::string quoted_messages(std::string text, const CallFiles& files) {
  for (const auto& [name, file] : files) replace_all(text, file, name);
  std::string line;
  for (const char letter : text) {
    const bool is_blank = static_cast<unsigned char>(letter) <= ' ' || letter == 127;
    if (!is_blank)
      line += letter;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  constexpr std::size_t kShown = 500;
  if (line.size() > kShown) line = "..." + line.substr(line.size() - kShown);
  return line;
}

[[noreturn]] void fail(const ExternalMethod& method, const std::string& problem, const ChildEnd& end,
                       const CallFiles& files) {
  std::string text = problem;
  for (const auto& [name, file] : files) replace_all(text, file, name);
  const std::string messages = quoted_messages(end.messages, files);
  throw std::runtime_error(method.name + ": " + text + (messages.empty() ? "" : "; it said: " + messages));
}

bool exists(const std::string& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

/// The answer in {group}, under a name that says what it is: numpy adds .npy to a name, or writes an array into an open file.
std::string group_file(const std::string& named) {
  const std::string array = named + ".npy";
  if (!exists(array) && exists(named) && read_file(named).rfind("\x93NUMPY", 0) == 0) fs::rename(named, array);
  return exists(array) ? array : named;
}

/// Whether a program that ended well wrote nothing into its answer, or an array of nothing: it selects nothing.
bool is_empty(const std::string& file) {
  const std::string content = read_file(file);
  return content.empty() ||
         (file.size() > 4 && file.substr(file.size() - 4) == ".npy" && parse_npy(file, content).rows.size() == 0);
}

}  // namespace

std::vector<OptionValue> ExternalMethod::options() const {
  return {{"command", "", command, "", "", "what is called"},
          {"timeout", "s", to_text(timeout_s), "", "", "longest call"}};
}

std::vector<std::string> ExternalMethod::files() const {
  std::vector<std::string> found;
  for (const std::string& word : split_words(command)) {
    std::error_code ignored;
    if (fs::is_regular_file(word, ignored)) found.push_back(word);
  }
  return found;
}

bool is_method_name(const std::string& name) {
  const auto is_odd = [](unsigned char letter) {
    const bool is_letter = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
    return !is_letter && !(letter >= '0' && letter <= '9') &&
           std::string("._+-").find(static_cast<char>(letter)) == std::string::npos;
  };
  return !name.empty() && name[0] != '.' && std::none_of(name.begin(), name.end(), is_odd) &&
         !look_up(methods(), name) && name != "oracle" && name != "baseline";
}

ExternalMethod parse_external(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw InvalidInput("--external", "method", corral::quoted(text), "NAME='COMMAND {matches} {group}'");
  ExternalMethod method{text.substr(0, equals), text.substr(equals + 1)};
  if (!is_method_name(method.name))
    throw InvalidInput("--external", "name", corral::quoted(method.name),
                       "letters, digits and . _ + - only, and no name of a grouper");
  if (split_words(method.command).empty() || !names_file(method, "{matches}") ||
      !(names_file(method, "{group}") || names_file(method, "{pose}")))
    throw InvalidInput("--external", "command of " + method.name, corral::quoted(method.command),
                       "a program with the words {matches} and {group}, {pose} or both");
  return method;
}

ExternalAnswer call_external(const ExternalMethod& method, const CorrespondenceSet& matches) {
  const TemporaryFolder folder;
  const CallFiles files = files_in(folder);
  const ChildEnd end = call(method, matches, files);
  if (end.is_timeout) fail(method, "killed after " + to_text(method.timeout_s) + " s (--external-timeout)", end, files);
  if (end.status > 128)
    fail(method, "ended by signal " + std::to_string(end.status - 128) + " (status " + std::to_string(end.status) + ")",
         end, files);
  if (end.status != 0) fail(method, "ended with status " + std::to_string(end.status), end, files);
  const bool has_group = names_file(method, "{group}"), has_pose = exists(files[2].second);
  const std::string group = has_group ? group_file(files[1].second) : "";
  if (has_group && !exists(group)) fail(method, "wrote no file {group}", end, files);
  if (!has_group && !has_pose) fail(method, "wrote no file {pose}", end, files);
  try {
    const bool selects_nothing = has_group && is_empty(group);
    ExternalAnswer answer{{}, end.milliseconds};
    if (!selects_nothing || has_pose)
      answer.found = read_answer({selects_nothing ? "" : group, has_pose ? files[2].second : "", "", {}}, matches);
    if (selects_nothing) answer.found.selected.clear();
    return answer;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    fail(method, error.what(), end, files);
  }
}

double start_up_ms(const ExternalMethod& method) {
  static std::mutex mutex;
  static std::map<std::string, double> known;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = known.find(method.command);
  if (found != known.end()) return found->second;
  const TemporaryFolder folder;
  CorrespondenceSet empty;
  empty.resolution = 1;
  return known[method.command] = call(method, empty, files_in(folder)).milliseconds;
}

MethodRecord evaluate_external(const ExternalMethod& method, const CorrespondenceSet& matches,
                               const std::optional<PairTruth>& truth, int repeat) {
  MethodRecord record;
  record.method = method.name;
  try {
    const double start_up = start_up_ms(method);
    std::vector<double> times;
    for (int i = 0; i < repeat; ++i) {
      ExternalAnswer answer = call_external(method, matches);
      times.push_back(std::max(0.0, answer.time_ms - start_up));
      if (i == 0) record.found = std::move(answer.found);
    }
    std::sort(times.begin(), times.end());
    record.time_ms = (times[(times.size() - 1) / 2] + times[times.size() / 2]) / 2;
    judge(record, matches, truth);
  } catch (const std::bad_alloc&) {
    throw;  // not a failure of the method
  } catch (const std::exception& error) {
    record.failure = *error.what() ? error.what() : "no reason given";
  }
  return record;
}

}  // namespace corral
