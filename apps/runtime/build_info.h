// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace corral {

/// How this program was built and where it runs.
struct BuildInfo {
  std::string version;   ///< "0.2.0"
  std::string commit;    ///< of the source tree, "-dirty" behind it if that was changed; "unknown" outside a repository
  std::string compiler;  ///< name and version
  std::string flags;
  std::map<std::string, std::string> libraries;  ///< versions by name
};
BuildInfo build_info();

struct MachineInfo {
  std::string processor, system;  ///< as the system calls them; no name of the machine
  int processors = 0;             ///< that it has online
  double memory_gb = 0;           ///< 10^9 bytes
};
MachineInfo machine_info();

}  // namespace corral
