// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace corral {

/// gnuplot is not installed, or failed.
struct GnuplotError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs scripts/<name>.gp of a report in its folder, which makes figures/<name>.pdf and .svg: the same bytes whenever it is
/// run with the same fonts (the PDF is dated 1970). Throws GnuplotError.
void run_gnuplot(const std::string& report, const std::string& name);

}  // namespace corral
