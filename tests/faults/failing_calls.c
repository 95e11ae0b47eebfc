// SPDX-License-Identifier: MIT
// Preloaded into a program, makes one of its file calls fail: the FAULT_CALL-th of those on FAULT_FOLDER and what lies below it,
// with the error number FAULT_ERRNO. Without FAULT_CALL none fails. Every call counted is a line of the file FAULT_LOG, which may
// not lie in the folder; where a call is made to fail, its line is the only one.
//
// A failing write puts half of its bytes into the file, a failing close closes: so do a full disk and NFS. All other failing
// calls do nothing.
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

static atomic_long calls;

/// The file of a descriptor.
static void name_of(int descriptor, char* name) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const long length = syscall(SYS_readlink, link, name, PATH_MAX - 1);
  name[length > 0 ? length : 0] = 0;
}

/// Counts a call on a path, or on the file of the descriptor where there is no path, and says whether it must fail.
static int fails(const char* call, int descriptor, const char* path) {
  const int before = errno;
  const char* folder = getenv("FAULT_FOLDER");
  char base[PATH_MAX] = "", name[2 * PATH_MAX + 2];
  if (folder == NULL) return 0;
  if (path != NULL && path[0] == '/')
    snprintf(name, sizeof name, "%s", path);
  else {
    if (path != NULL && descriptor == AT_FDCWD)
      syscall(SYS_getcwd, base, sizeof base);
    else
      name_of(descriptor, base);
    snprintf(name, sizeof name, "%s%s%s", base, path != NULL ? "/" : "", path != NULL ? path : "");
  }
  errno = before;
  const size_t length = strlen(folder);
  if (strncmp(name, folder, length) != 0 || (name[length] != '/' && name[length] != 0)) return 0;
  const long number = atomic_fetch_add(&calls, 1) + 1;
  const char *chosen = getenv("FAULT_CALL"), *error = getenv("FAULT_ERRNO"), *log = getenv("FAULT_LOG");
  const int is_chosen = chosen != NULL && number == atol(chosen);
  if (log != NULL && (is_chosen || chosen == NULL)) {
    char line[3 * PATH_MAX];
    const int size = snprintf(line, sizeof line, "%ld %s %s\n", number, call, name);
    const long file = syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND, 0666);
    syscall(SYS_write, file, line, size);
    syscall(SYS_close, file);
  }
  errno = is_chosen && error != NULL ? atoi(error) : before;
  return is_chosen;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

// A call on a path below the working directory, on one below an open folder, and on a descriptor.
#define ON_PATH(type, failed, name, parameters, arguments) \
  type name parameters { return fails(#name, AT_FDCWD, path) ? failed : REAL(name) arguments; }
#define ON_PATH_AT(type, failed, name, parameters, arguments) \
  type name parameters { return fails(#name, at, path) ? failed : REAL(name) arguments; }
#define ON_FILE(type, failed, name, parameters, arguments) \
  type name parameters { return fails(#name, file, NULL) ? failed : REAL(name) arguments; }

static mode_t mode_in(int flags, va_list rest) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
}

#define OPEN(name)                                                            \
  int name(const char* path, int flags, ...) {                                \
    va_list rest;                                                             \
    va_start(rest, flags);                                                    \
    const mode_t mode = mode_in(flags, rest);                                 \
    va_end(rest);                                                             \
    return fails(#name, AT_FDCWD, path) ? -1 : REAL(name)(path, flags, mode); \
  }
#define OPENAT(name)                                                        \
  int name(int at, const char* path, int flags, ...) {                      \
    va_list rest;                                                           \
    va_start(rest, flags);                                                  \
    const mode_t mode = mode_in(flags, rest);                               \
    va_end(rest);                                                           \
    return fails(#name, at, path) ? -1 : REAL(name)(at, path, flags, mode); \
  }
OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
ON_PATH(int, -1, creat, (const char* path, mode_t mode), (path, mode))
ON_PATH(int, -1, mkstemp, (char* path), (path))
ON_PATH(int, -1, mkstemp64, (char* path), (path))
ON_PATH(int, -1, mkostemp, (char* path, int flags), (path, flags))
ON_PATH(int, -1, mkostemp64, (char* path, int flags), (path, flags))
ON_PATH(FILE*, NULL, fopen, (const char* path, const char* mode), (path, mode))
ON_PATH(FILE*, NULL, fopen64, (const char* path, const char* mode), (path, mode))
ON_PATH(DIR*, NULL, opendir, (const char* path), (path))
ON_FILE(DIR*, NULL, fdopendir, (int file), (file))

ON_FILE(ssize_t, -1, read, (int file, void* data, size_t size), (file, data, size))
ON_FILE(ssize_t, -1, pread, (int file, void* data, size_t size, off_t at), (file, data, size, at))
ON_FILE(int, -1, fsync, (int file), (file))
ON_FILE(int, -1, fdatasync, (int file), (file))
ON_FILE(int, -1, ftruncate, (int file, off_t size), (file, size))
ON_FILE(int, -1, fchmod, (int file, mode_t mode), (file, mode))
ON_FILE(int, -1, flock, (int file, int operation), (file, operation))

ssize_t write(int file, const void* data, size_t size) {
  if (!fails("write", file, NULL)) return REAL(write)(file, data, size);
  const int error = errno;
  syscall(SYS_write, file, data, size / 2);
  errno = error;
  return -1;
}
ON_FILE(ssize_t, -1, pwrite, (int file, const void* data, size_t size, off_t at), (file, data, size, at))
ON_FILE(ssize_t, -1, writev, (int file, const struct iovec* parts, int count), (file, parts, count))

int close(int file) {
  if (!fails("close", file, NULL)) return REAL(close)(file);
  const int error = errno;
  syscall(SYS_close, file);
  errno = error;
  return -1;
}

struct dirent* readdir(DIR* folder) {
  return fails("readdir", dirfd(folder), NULL) ? NULL : REAL(readdir)(folder);
}
struct dirent64* readdir64(DIR* folder) {
  return fails("readdir64", dirfd(folder), NULL) ? NULL : REAL(readdir64)(folder);
}

ON_PATH(int, -1, rename, (const char* path, const char* to), (path, to))
ON_PATH_AT(int, -1, renameat, (int at, const char* path, int to_at, const char* to), (at, path, to_at, to))
ON_PATH(int, -1, link, (const char* path, const char* to), (path, to))
ON_PATH(int, -1, unlink, (const char* path), (path))
ON_PATH_AT(int, -1, unlinkat, (int at, const char* path, int flags), (at, path, flags))
ON_PATH(int, -1, remove, (const char* path), (path))
ON_PATH(int, -1, rmdir, (const char* path), (path))
ON_PATH(int, -1, mkdir, (const char* path, mode_t mode), (path, mode))
ON_PATH(int, -1, truncate, (const char* path, off_t size), (path, size))
ON_PATH(int, -1, stat, (const char* path, struct stat* status), (path, status))
ON_PATH(int, -1, lstat, (const char* path, struct stat* status), (path, status))
ON_FILE(int, -1, fstat, (int file, struct stat* status), (file, status))
ON_PATH(int, -1, stat64, (const char* path, struct stat64* status), (path, status))
ON_PATH(int, -1, lstat64, (const char* path, struct stat64* status), (path, status))
ON_FILE(int, -1, fstat64, (int file, struct stat64* status), (file, status))
ON_PATH_AT(int, -1, fstatat, (int at, const char* path, struct stat* status, int flags), (at, path, status, flags))
ON_PATH_AT(int, -1, utimensat, (int at, const char* path, const struct timespec times[2], int flags),
           (at, path, times, flags))
ON_PATH(ssize_t, -1, readlink, (const char* path, char* target, size_t size), (path, target, size))
ON_PATH(char*, NULL, realpath, (const char* path, char* found), (path, found))
