// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/report/figure/method_style.h"

namespace corral {

enum class Align { Left, Center, Right };

/// What is drawn on the paper of a figure beside its plots: words, lines and markers, by points from the upper left corner.
class Drawing {
 public:
  Drawing(double width, double height) : width_(width), height_(height) {}

  /// The middle of the line of text is at y; an upright one reads from below and is centred at (x, y).
  void words(double x, double y, const std::string& text, Align align);
  void paragraph(double x, double top, const std::vector<std::string>& lines);  ///< centred, from y = top down
  void upright_words(double x, double y, const std::string& text);
  void line(double x1, double y1, double x2, double y2, const std::string& pen);
  void marker(double x, double y, const std::string& look);

  /// gnuplot's commands for the area of a plot.
  std::string margins(double left, double right, double top, double bottom) const;

  const std::string& commands() const { return commands_; }
  double width() const { return width_; }
  double height() const { return height_; }

 private:
  std::string place(double x, double y) const;

  double width_, height_;
  std::string commands_;
};

/// How the line and the marker of a grouper are drawn.
std::string pen_of(const MethodStyle& style);
std::string marker_of(const MethodStyle& style);

/// Text as a gnuplot string without special characters.
std::string gnuplot_text(const std::string& text);
/// Labels at numbers, for `set xtics`.
std::string tics_text(const std::vector<std::string>& labels, const std::vector<double>& numbers);

/// A script for gnuplot, to be run in the folder of scripts: `plots` on the drawing, as PDF and SVG. A plot is commands of a
/// line each.
std::string figure_script(const std::string& name, const Drawing& drawing, const std::vector<std::string>& plots);

}  // namespace corral
