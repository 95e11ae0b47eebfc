// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/picture/image.h"

namespace corral {

/// Draws a line of text in strokes, its capitals `size` pixels high, starting at `left`; the y of `left` is the baseline.
/// Each byte that is not printable ASCII becomes a question mark.
void draw_text(Image& image, const Place& left, const std::string& text, double size, const Color& color);

/// The width of that text in pixels.
double text_width(const std::string& text, double size);

}  // namespace corral
