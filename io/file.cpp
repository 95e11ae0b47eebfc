// SPDX-License-Identifier: MIT
#include "io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& action) {
  throw IoError(path, "", "cannot " + action + " (" + std::strerror(errno) + ")");
}

/// A file descriptor that closes itself.
struct Descriptor {
  int value;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

void write_all(int descriptor, const std::string& content, const std::string& path) {
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t written = ::write(descriptor, content.data() + done, content.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "be written");
    done += static_cast<std::size_t>(written);
  }
}

mode_t default_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

}  // namespace

std::string read_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw IoError(path, "", "does not exist");
  if (fs::is_directory(status)) throw IoError(path, "", "is a directory, expected a file");
  if (!error && !fs::is_regular_file(status) && !fs::is_fifo(status))
    throw IoError(path, "", "is a device, expected a file");
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.value < 0) fail(path, "be opened");
  std::string content;
  char buffer[1 << 16];
  while (true) {
    const ssize_t count = ::read(file.value, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "be read");
    if (count == 0) return content;
    content.append(buffer, static_cast<std::size_t>(count));
  }
}

void write_file(const std::string& path, const std::string& content) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw IoError(path, "", "is a directory, expected a file to write");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    const Descriptor file{::open(path.c_str(), O_WRONLY | O_CLOEXEC)};
    if (file.value < 0) fail(path, "be opened for writing");
    return write_all(file.value, content, path);
  }
  // A link stays a link: what it names is replaced.
  const fs::path place = fs::is_symlink(fs::symlink_status(path, error)) ? fs::canonical(path, error) : fs::path(path);
  std::string temporary = (place.empty() ? path : place.string()) + ".XXXXXX";
  const std::string destination = temporary.substr(0, temporary.size() - 7);
  const Descriptor file{::mkstemp(temporary.data())};
  if (file.value < 0) fail(path, "be created");
  try {
    write_all(file.value, content, path);
    if (::fchmod(file.value, default_mode()) != 0) fail(path, "be given its permissions");
    if (::rename(temporary.c_str(), destination.c_str()) != 0) fail(path, "be replaced");
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

void remove_file(const std::string& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error) && !fs::remove(path, error))
    throw IoError(path, "", "cannot be removed (" + error.message() + ")");
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path))
    throw IoError(path, "", "cannot be created as a folder (" + error.message() + ")");
}

}  // namespace corral
