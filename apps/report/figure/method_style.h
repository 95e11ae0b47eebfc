// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

namespace corral {

/// The look of a grouper in every figure.
struct MethodStyle {
  std::string label;      ///< for people, such as "3DHV"
  std::string color;      ///< "#rrggbb"
  int point = 0;          ///< gnuplot's number of the marker; 0: none
  std::string dash = "";  ///< gnuplot's pattern; empty: solid
};

/// What methods of other programs are called in figures, by their names.
using MethodTitles = std::map<std::string, std::string>;

/// A style for each of these groupers. The paper's seven always have the same one, in the colours of Okabe and Ito, which
/// colour-blind readers can tell apart; "oracle" and "baseline" are grey. Others get theirs in the order of their names, which
/// are also their labels unless they have titles; from the ninth on styles repeat.
std::map<std::string, MethodStyle> method_styles(const std::vector<std::string>& methods,
                                                 const MethodTitles& titles = {});

/// True for "oracle" and "baseline", which bound what a grouper can do but are not groupers.
bool is_bound(const std::string& method);

}  // namespace corral
