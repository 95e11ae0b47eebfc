// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace corral {

/// A method's distribution of an error; absent where so many pairs have none that the quantile is beyond every number.
struct Box {
  std::string method;
  std::array<std::optional<double>, 5> quantiles;  ///< 5, 25, 50, 75 and 95 of 100
  int pairs = 0, without = 0;                      ///< without a value
};

/// The box of some values, those that are absent counted as worse than any. Quantiles between two values are linear.
Box box_of(const std::string& method, const std::vector<std::optional<double>>& values);

/// Boxes beside each other on a logarithmic axis.
struct BoxPanel {
  std::string name;  ///< of its files, as of a Panel
  std::string title, y_axis;
  std::vector<Box> boxes;
};

/// x,method,q05,q25,q50,q75,q95,pairs,without
std::string box_csv(const BoxPanel& panel);
/// A script for gnuplot as panel_script's; what is absent ends at the upper border.
std::string box_script(const BoxPanel& panel);

}  // namespace corral
