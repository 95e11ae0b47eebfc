// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace corral {

/// gnuplot is not installed, or failed.
struct GnuplotError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `<name>.gp` in its folder, which makes `<name>.pdf` and `<name>.svg` there: the same bytes whenever it is run
/// (the PDF is dated 1970). Throws GnuplotError.
void run_gnuplot(const std::string& folder, const std::string& name);

}  // namespace corral
