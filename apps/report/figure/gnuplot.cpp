// SPDX-License-Identifier: MIT
#include "apps/report/figure/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <filesystem>

#include "apps/report/figure/folders.h"
#include "io/disk/file.h"

extern char** environ;

namespace corral {
namespace {

/// The folder that the program runs in.
struct Actions {
  explicit Actions(const std::string& folder) {
    ::posix_spawn_file_actions_init(&value);
    ::posix_spawn_file_actions_addchdir_np(&value, folder.c_str());
    // It warns of every curve without any value.
    ::posix_spawn_file_actions_addopen(&value, 2, "/dev/null", O_WRONLY, 0);
  }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;
  ~Actions() { ::posix_spawn_file_actions_destroy(&value); }
  posix_spawn_file_actions_t value;
};

/// The date is plain text; another date of the same length changes no offset.
void date_1970(const std::string& path) {
  const std::string key = "/CreationDate (D:", date = "19700101000000";
  std::string pdf = read_file(path);
  const std::size_t place = pdf.find(key);
  if (place == std::string::npos || place + key.size() + date.size() > pdf.size()) return;
  pdf.replace(place + key.size(), date.size(), date);
  write_file(path, pdf);
}

}  // namespace

void run_gnuplot(const std::string& report, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(report) / kScripts;
  std::string program = "gnuplot", plain = "-d", script = name + ".gp";  // -d: without the user's own settings
  char* arguments[] = {program.data(), plain.data(), script.data(), nullptr};
  const Actions actions(folder.string());
  pid_t child = 0;
  if (::posix_spawnp(&child, program.c_str(), &actions.value, nullptr, arguments, environ) != 0)
    throw GnuplotError(
        "gnuplot cannot be run: install it (Debian: gnuplot-nox), then run this again; data, tables and scripts are "
        "in " +
        report);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw GnuplotError("gnuplot cannot draw " + (folder / script).string() + ": run it there to see why");
  date_1970((std::filesystem::path(report) / kFigures / (name + ".pdf")).string());
}

}  // namespace corral
