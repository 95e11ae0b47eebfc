// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace corral {

/// Red, green and blue, 0 .. 255 each.
using Color = Eigen::Vector3f;

/// A position in a picture in pixels from its upper left corner, x to the right and y down. The centre of the first pixel
/// is (0.5, 0.5).
using Place = Eigen::Vector2d;

/// A picture: three bytes per pixel, row by row from the top.
struct Image {
  Image(int width_, int height_, const Color& background);

  int width, height;
  std::vector<std::uint8_t> bytes;

  Color at(int x, int y) const;
  /// Blends a colour over a pixel; opacity 0 .. 1.
  void blend(int x, int y, const Color& color, double opacity);
};

/// How a line is drawn.
struct Pen {
  Color color;
  double width = 1;    ///< pixels
  double opacity = 1;  ///< 0 .. 1
};

/// A straight line with round ends and smooth borders; a dot where both ends are the same. It is clipped to the picture.
void draw_line(Image& image, const Place& from, const Place& to, const Pen& pen);

/// Copies a picture into another, its upper left corner at (x, y), clipped.
void paste(Image& image, const Image& part, int x, int y);

/// The picture as a PNG file. The same picture gives the same bytes. Throws std::runtime_error if libpng fails.
std::string png_bytes(const Image& image);

}  // namespace corral
