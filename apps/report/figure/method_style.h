// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

namespace corral {

/// How a method looks in every figure.
struct MethodStyle {
  std::string label;      ///< for people, such as "3DHV"
  std::string color;      ///< "#rrggbb"
  int point = 0;          ///< gnuplot's number of the marker; 0: none
  std::string dash = "";  ///< gnuplot's pattern; empty: solid
};

/// A style for each of these methods. The paper's seven always have the same, in the colours of Okabe and Ito that
/// colour-blind readers tell apart; "oracle" and "floor" are grey. Others take theirs in the order of their names, and
/// go by these names; from the ninth on they share.
std::map<std::string, MethodStyle> method_styles(const std::vector<std::string>& methods);

/// True for "oracle" and "floor", which bound what a grouper can do and are none themselves.
bool is_bound(const std::string& method);

}  // namespace corral
