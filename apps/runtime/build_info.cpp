// SPDX-License-Identifier: MIT
#include "apps/runtime/build_info.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <sstream>

#include "apps/runtime/build_facts.h"  // written by build_facts.cmake
#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {
namespace {

/// "Eigen=3.4.0;CGAL=5.5.1" as pairs.
std::map<std::string, std::string> libraries_of(const std::string& text) {
  std::map<std::string, std::string> libraries;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ';');)
    if (const std::size_t equal = item.find('='); equal != std::string::npos)
      libraries[item.substr(0, equal)] = item.substr(equal + 1);
  return libraries;
}

std::string processor_name() {
  try {
    std::istringstream lines(read_file("/proc/cpuinfo"));
    for (std::string line; std::getline(lines, line);)
      if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
        return line.substr(line.find(": ") + 2);
  } catch (const IoError&) {  // another system
  }
  return "unknown";
}

}  // namespace

BuildInfo build_info() {
  return {CORRAL_VERSION, CORRAL_COMMIT, CORRAL_COMPILER, CORRAL_FLAGS, libraries_of(CORRAL_LIBRARIES)};
}

MachineInfo machine_info() {
  MachineInfo machine;
  machine.processor = processor_name();
  utsname system{};
  if (::uname(&system) == 0) machine.system = std::string(system.sysname) + " " + system.release + " " + system.machine;
  machine.processors = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  machine.memory_gb =
      1e-9 * static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return machine;
}

}  // namespace corral
