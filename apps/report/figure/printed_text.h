// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace corral {

// Lengths in figures are in points, 1/72 inch.
constexpr double kColumnWidth = 8.5 * 72 / 2.54, kPageWidth = 17 * 72 / 2.54;
constexpr double kTextSize = 8;                   ///< of all text
constexpr double kLine = 10;                      ///< from one line of text to the next
constexpr double kGap = 5;                        ///< between two words that do not belong together
constexpr double kMostOfName = kColumnWidth / 3;  ///< the width of the name of a grouper or level

/// The font of figures, or what fontconfig puts in its place: Liberation Sans has the same widths.
constexpr const char* kFontName = "Arial";

/// The width of a line of text (UTF-8) at kTextSize, from the font file that gnuplot will draw with. Kerning, which moves
/// letters closer, is left out.
double printed_width(const std::string& text);

double widest_of(const std::vector<std::string>& texts);

/// The text, or as much of its beginning as fits the width with "..." behind it.
std::string shortened(const std::string& text, double width);

/// The text in lines of at most that width, broken at spaces; a longer word is shortened.
std::vector<std::string> wrapped(const std::string& text, double width);

}  // namespace corral
