// SPDX-License-Identifier: MIT
#include "apps/picture/image.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace corral {

Image::Image(int width_, int height_, const Color& background)
    : width(width_), height(height_), bytes(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(std::lround(background[static_cast<Eigen::Index>(i % 3)]));
}

Color Image::at(int x, int y) const {
  const std::uint8_t* pixel = &bytes[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x)];
  return {static_cast<float>(pixel[0]), static_cast<float>(pixel[1]), static_cast<float>(pixel[2])};
}

void Image::blend(int x, int y, const Color& color, double opacity) {
  std::uint8_t* pixel = &bytes[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x)];
  for (int i = 0; i < 3; ++i)
    pixel[i] = static_cast<std::uint8_t>(std::lround((1 - opacity) * pixel[i] + opacity * color[i]));
}

void draw_line(Image& image, const Place& from, const Place& to, const Pen& pen) {
  const Place along = to - from;
  const double squared = along.squaredNorm(), reach = pen.width / 2 + 0.5;  // half a pixel of soft border
  const int first = std::max(0, static_cast<int>(std::floor(std::min(from.y(), to.y()) - reach)));
  const int last = std::min(image.height - 1, static_cast<int>(std::ceil(std::max(from.y(), to.y()) + reach)));
  for (int y = first; y <= last; ++y) {
    double low = std::min(from.x(), to.x()) - reach, high = std::max(from.x(), to.x()) + reach;
    if (std::abs(along.y()) > 1e-9) {  // where this row comes near the line
      const double middle = from.x() + (y + 0.5 - from.y()) * along.x() / along.y();
      const double half = reach * std::sqrt(squared) / std::abs(along.y());
      low = std::max(low, middle - half);
      high = std::min(high, middle + half);
    }
    const int end = std::min(image.width - 1, static_cast<int>(std::ceil(std::min(high, image.width + 1.0))));
    for (int x = std::max(0, static_cast<int>(std::floor(std::max(low, -1.0)))); x <= end; ++x) {
      const Place offset = Place(x + 0.5, y + 0.5) - from;
      const double share = squared > 0 ? std::clamp(offset.dot(along) / squared, 0.0, 1.0) : 0;
      const double covered = std::clamp(reach - (offset - share * along).norm(), 0.0, 1.0) * std::min(1.0, pen.width);
      if (covered > 0) image.blend(x, y, pen.color, covered * pen.opacity);
    }
  }
}

void paste(Image& image, const Image& part, int x, int y) {
  for (int row = std::max(0, -y); row < std::min(part.height, image.height - y); ++row)
    for (int column = std::max(0, -x); column < std::min(part.width, image.width - x); ++column)
      image.blend(x + column, y + row, part.at(column, row), 1);
}

std::string png_bytes(const Image& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  std::string bytes;
  const auto encode = [&](void* memory) {
    if (png_image_write_to_memory(&header, memory, &size, 0, image.bytes.data(), 0, nullptr) == 0)
      throw std::runtime_error(std::string("a picture cannot be written as PNG: ") + header.message);
  };
  encode(nullptr);  // only computes the size
  bytes.resize(size);
  encode(bytes.data());
  bytes.resize(size);
  return bytes;
}

}  // namespace corral
