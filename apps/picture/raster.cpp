// SPDX-License-Identifier: MIT
#include "apps/picture/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace corral {
namespace {

/// Twice the area of the triangle a, b, p; its sign is the side of a b on which the point lies.
double side(const Place& a, const Place& b, const Place& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

}  // namespace

Raster::Raster(int width, int height, const Color& background)
    : width_(kSamples * width),
      height_(kSamples * height),
      background_(background),
      depths_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
              -std::numeric_limits<float>::infinity()),
      colors_(Image(width_, height_, background).bytes) {}

Raster::Box Raster::samples_within(const Place& low, const Place& high) const {
  // Sample i lies at (i + 0.5) / kSamples; clamped before it becomes an int.
  const auto first = [](double at, int count) { return std::clamp(kSamples * at - 0.5, 0.0, count - 0.0); };
  const auto last = [](double at, int count) { return std::clamp(kSamples * at - 0.5, -1.0, count - 1.0); };
  return {static_cast<int>(std::ceil(first(low.x(), width_))), static_cast<int>(std::floor(last(high.x(), width_))),
          static_cast<int>(std::ceil(first(low.y(), height_))), static_cast<int>(std::floor(last(high.y(), height_)))};
}

void Raster::fill(int x, int y, double depth, const Color& color) {
  const std::size_t sample =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  if (!(static_cast<float>(depth) > depths_[sample])) return;
  depths_[sample] = static_cast<float>(depth);
  for (int i = 0; i < 3; ++i)
    colors_[3 * sample + static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(std::clamp(color[i], 0.0F, 255.0F) + 0.5F);
}

void Raster::draw_triangle(const Corner& a, const Corner& b, const Corner& c) {
  const Place pa = a.place.head<2>(), pb = b.place.head<2>(), pc = c.place.head<2>();
  const double area = side(pa, pb, pc);
  if (!(std::abs(area) > 0)) return;
  const Box box = samples_within(pa.cwiseMin(pb).cwiseMin(pc), pa.cwiseMax(pb).cwiseMax(pc));
  for (int y = box.top; y <= box.bottom; ++y)
    for (int x = box.left; x <= box.right; ++x) {
      const Place p = Place(x + 0.5, y + 0.5) / kSamples;
      const double wa = side(pb, pc, p) / area, wb = side(pc, pa, p) / area, wc = side(pa, pb, p) / area;
      if (!(wa >= 0 && wb >= 0 && wc >= 0)) continue;
      fill(x, y, wa * a.place.z() + wb * b.place.z() + wc * c.place.z(),
           static_cast<float>(wa) * a.color + static_cast<float>(wb) * b.color + static_cast<float>(wc) * c.color);
    }
}

void Raster::draw_disc(const Corner& middle, double radius) {
  const Place center = middle.place.head<2>();
  if (!center.allFinite()) return;
  const Box box = samples_within(center - Place(radius, radius), center + Place(radius, radius));
  for (int y = box.top; y <= box.bottom; ++y)
    for (int x = box.left; x <= box.right; ++x)
      if ((Place(x + 0.5, y + 0.5) / kSamples - center).squaredNorm() <= radius * radius)
        fill(x, y, middle.place.z(), middle.color);
}

Image Raster::image() const {
  Image image(width_ / kSamples, height_ / kSamples, background_);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < 3 * image.width; ++x) {
      int sum = 0;
      for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i)
          sum += colors_[static_cast<std::size_t>(kSamples * y + j) * static_cast<std::size_t>(3 * width_) +
                         static_cast<std::size_t>(3 * (kSamples * (x / 3) + i) + x % 3)];
      image.bytes[static_cast<std::size_t>(y) * static_cast<std::size_t>(3 * image.width) +
                  static_cast<std::size_t>(x)] = static_cast<std::uint8_t>((sum + 4) / (kSamples * kSamples));
    }
  return image;
}

}  // namespace corral
