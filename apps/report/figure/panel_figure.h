// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/report/figure/panel.h"

namespace corral {

/// Panels side by side under one title and one legend: one in the width of a column, more in that of a page.
struct PanelFigure {
  std::string name;  ///< of its files, as of a Panel
  std::string title;
  std::vector<Panel> panels;  ///< not empty
};

/// A script for gnuplot that draws the figure from the data of its panels.
std::string panel_script(const PanelFigure& figure);

}  // namespace corral
