// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "apps/report/figure/method_style.h"

namespace corral {

/// A grouper's distribution of an error; a quantile is absent where so many pairs have no value that it is infinite.
struct Box {
  std::string method;
  std::array<std::optional<double>, 5> quantiles;  ///< 5, 25, 50, 75 and 95 of 100
  int pairs = 0, without = 0;                      ///< without a value
};

/// The box of some values, absent ones counted as worse than any. Quantiles are interpolated linearly.
Box box_of(const std::string& method, const std::vector<std::optional<double>>& values);

/// Boxes below each other on a logarithmic axis.
struct BoxPanel {
  std::string name;  ///< of its files, as of a Panel
  std::string title, axis;
  std::vector<Box> boxes;
  MethodTitles titles = {};
};

/// x,method,q05,q25,q50,q75,q95,pairs,without
std::string box_csv(const BoxPanel& panel);
/// A script for gnuplot as that of panel_script, in the width of a column: from quantile to quantile the whiskers, the box and
/// its median. An absent quantile is drawn at the right border.
std::string box_script(const BoxPanel& panel);

}  // namespace corral
