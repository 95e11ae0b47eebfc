// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/picture/image.h"

namespace corral {

/// Writes a line of text with strokes, its capitals `size` pixels high, from `left` on; y of `left` is the foot of the
/// letters. Each byte that is not printable ASCII becomes a question mark.
void draw_text(Image& image, const Place& left, const std::string& text, double size, const Color& color);

/// How wide that would be, in pixels.
double text_width(const std::string& text, double size);

}  // namespace corral
