// SPDX-License-Identifier: MIT
// What libFuzzer calls. The program is called by the name fuzz_<target>, a link to the one that holds all targets of a list.
#include "tests/fuzz/target.h"

#include <cstdint>

#include "kernel/error.h"

using namespace corral;

namespace {
fuzz::Target chosen;
}

extern "C" int LLVMFuzzerInitialize(int*, char*** arguments) {
  const std::string program = **arguments;
  const std::size_t at = program.rfind("fuzz_");
  const std::string name = at == std::string::npos ? "" : program.substr(at + 5);
  for (const fuzz::Target& each : fuzz::CORRAL_TARGETS())
    if (name == each.name) chosen = each;
  fuzz::require(chosen.run != nullptr, "the program is called by the name of a target");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    chosen.run(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const IoError&) {
  } catch (const InvalidInput&) {
  }
  return 0;
}
