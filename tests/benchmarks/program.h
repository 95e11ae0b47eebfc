// SPDX-License-Identifier: MIT
#pragma once

// What every benchmark program does around its measurements.

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace corral::benchmarks {

/// The command line without the options of the benchmark library.
struct Arguments {
  bool as_csv = false;
  std::vector<std::string> words;  ///< everything else, in order
};

/// Calls body(arguments) and returns its exit status; 3, and why, where it throws.
template <class Body>
int run_program(const char* name, int argc, char** argv, Body body) {
  try {
    benchmark::Initialize(&argc, argv);
    Arguments arguments;
    for (int i = 1; i < argc; ++i)
      if (const std::string word = argv[i]; word == "--csv")
        arguments.as_csv = true;
      else
        arguments.words.push_back(word);
    return body(arguments);
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return 3;
  }
}

/// Where the default data are: the environment variable CORRAL_DATA, or else the folder given.
inline std::string data_folder(const char* otherwise) {
  const char* data = std::getenv("CORRAL_DATA");
  return data ? data : otherwise;
}

inline int no_mesh() {
  std::cerr << "no mesh: name some, or let apps/quickstart fetch the default data\n";
  return 2;
}

}  // namespace corral::benchmarks
