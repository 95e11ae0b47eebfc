// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "apps/picture/image.h"

namespace corral {

/// A point of a surface, projected to a picture.
struct Corner {
  Eigen::Vector3d place;  ///< x and y in pixels as in a picture, z towards the viewer
  Color color;
};

/// A depth buffer with nine samples per pixel. The same calls in the same order give the same bytes.
class Raster {
 public:
  Raster(int width, int height, const Color& background);

  /// Fills the samples inside a triangle, its border included; colours are interpolated between the corners. Samples outside
  /// the picture or behind nearer ones are skipped.
  void draw_triangle(const Corner& a, const Corner& b, const Corner& c);

  /// Fills a disc that faces the viewer.
  void draw_disc(const Corner& middle, double radius);

  /// The mean of the samples of every pixel.
  Image image() const;

 private:
  static constexpr int kSamples = 3;  ///< along each side of a pixel

  struct Box {
    int left, right, top, bottom;  ///< samples, the last ones included
  };
  Box samples_within(const Place& low, const Place& high) const;
  void fill(int x, int y, double depth, const Color& color);

  int width_, height_;  ///< in samples
  Color background_;
  std::vector<float> depths_;
  std::vector<std::uint8_t> colors_;
};

}  // namespace corral
