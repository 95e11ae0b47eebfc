// SPDX-License-Identifier: MIT
#include "apps/report/figure/drawing.h"

#include "apps/report/figure/folders.h"
#include "apps/report/figure/printed_text.h"
#include "apps/runtime/text_table.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

std::string indented(const std::string& lines) {
  std::string text = lines.empty() ? "" : "  ";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += lines[i];
    if (lines[i] == '\n' && i + 1 < lines.size()) text += "  ";
  }
  return text;
}

}  // namespace

std::string Drawing::place(double x, double y) const {
  return "screen " + fixed(x / width_, 5) + "," + fixed(1 - y / height_, 5);
}

void Drawing::words(double x, double y, const std::string& text, Align align) {
  const char* const side = align == Align::Left ? "left" : align == Align::Center ? "center" : "right";
  commands_ += "set label " + gnuplot_text(text) + " at " + place(x, y) + " " + side + "\n";
}

void Drawing::paragraph(double x, double top, const std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i)
    words(x, top + (static_cast<double>(i) + 0.5) * kLine, lines[i], Align::Center);
}

void Drawing::upright_words(double x, double y, const std::string& text) {
  commands_ += "set label " + gnuplot_text(text) + " at " + place(x, y) + " rotate by 90 center\n";
}

void Drawing::line(double x1, double y1, double x2, double y2, const std::string& pen) {
  commands_ += "set arrow from " + place(x1, y1) + " to " + place(x2, y2) + " nohead " + pen + "\n";
}

void Drawing::marker(double x, double y, const std::string& look) {
  commands_ += "set label '' at " + place(x, y) + " point " + look + "\n";
}

std::string Drawing::margins(double left, double right, double top, double bottom) const {
  return "set lmargin at screen " + fixed(left / width_, 5) + "; set rmargin at screen " + fixed(right / width_, 5) +
         "\nset tmargin at screen " + fixed(1 - top / height_, 5) + "; set bmargin at screen " +
         fixed(1 - bottom / height_, 5) + "\n";
}

std::string pen_of(const MethodStyle& style) {
  return "linewidth 1.3 dashtype " + (style.dash.empty() ? "1" : style.dash) + " linecolor rgb '" + style.color + "'";
}

std::string marker_of(const MethodStyle& style) { return "pointsize 0.5 pointtype " + std::to_string(style.point); }

std::string gnuplot_text(const std::string& text) {
  std::string quoted = "'";
  for (const char character : text) {
    if (character == '\'') quoted += '\'';  // a quote is doubled
    quoted += static_cast<unsigned char>(character) < ' ' ? ' ' : character;
  }
  return quoted + "'";
}

std::string tics_text(const std::vector<std::string>& labels, const std::vector<double>& numbers) {
  std::string text = "(";
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::string label;
    for (const char character : labels[i]) label += character == '%' ? "%%" : std::string(1, character);  // a format
    text += (i > 0 ? ", " : "") + gnuplot_text(label) + " " + to_text(numbers[i]);
  }
  return text + ")";
}

std::string figure_script(const std::string& name, const Drawing& drawing, const std::vector<std::string>& plots) {
  constexpr double kPixels = 1.5;  // for a point, on a screen
  const std::string font = "noenhanced rounded font '" + std::string(kFontName) + ",";
  std::string text =
      "# Made by corral report. Change what you like and run gnuplot on this file, in its folder.\n"
      "set encoding utf8\nset datafile separator ','\nset border 3 linewidth 0.6 linecolor rgb '#404040'\n"
      "set tics nomirror out scale 0.5 textcolor rgb '#000000'\n"
      "set grid ytics linecolor rgb '#dddddd' linewidth 0.5 dashtype 1\nunset key\n"
      "do for [ending in 'pdf svg'] {\n  if (ending eq 'pdf') {\n    set terminal pdfcairo " +
      font + to_text(kTextSize) + "' fontscale 0.75 linewidth 1 size " +  // 0.75: its points are those of 96 to an inch
      fixed(drawing.width() / 72 * 2.54, 3) + "cm," + fixed(drawing.height() / 72 * 2.54, 3) +
      "cm\n  } else {\n    set terminal svg " + font + to_text(kPixels * kTextSize) + "' size " +
      fixed(kPixels * drawing.width(), 0) + "," + fixed(kPixels * drawing.height(), 0) + "\n  }\n  set output '" +
      kFromScripts + kFigures + name + ".'.ending\n  set multiplot\n" + indented(drawing.commands());
  for (const std::string& plot : plots) text += indented(plot) + "  unset label\n  unset arrow\n";
  return text + "  unset multiplot\n}\nset output\n";
}

}  // namespace corral
