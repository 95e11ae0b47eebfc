// SPDX-License-Identifier: MIT
#include "apps/report/figure/printed_text.h"

#include <fontconfig/fontconfig.h>
#include <ft2build.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include FT_FREETYPE_H

namespace corral {
namespace {

/// The file that fontconfig finds for kFontName, and the number of the font in it; empty if there is no font at all.
std::pair<std::string, int> font_file() {
  const std::unique_ptr<FcConfig, decltype(&FcConfigDestroy)> config(FcInitLoadConfigAndFonts(), FcConfigDestroy);
  const auto* name = reinterpret_cast<const FcChar8*>(kFontName);
  const std::unique_ptr<FcPattern, decltype(&FcPatternDestroy)> wanted(FcNameParse(name), FcPatternDestroy);
  if (!config || !wanted) return {};
  FcConfigSubstitute(config.get(), wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult result = FcResultMatch;
  const std::unique_ptr<FcPattern, decltype(&FcPatternDestroy)> found(FcFontMatch(config.get(), wanted.get(), &result),
                                                                      FcPatternDestroy);
  FcChar8* file = nullptr;
  int index = 0;
  if (!found || FcPatternGetString(found.get(), FC_FILE, 0, &file) != FcResultMatch) return {};
  FcPatternGetInteger(found.get(), FC_INDEX, 0, &index);
  return {reinterpret_cast<const char*>(file), index};
}

class Font {
 public:
  Font() {
    const auto [file, index] = font_file();
    if (file.empty() || FT_Init_FreeType(&library_) != 0) return;
    if (FT_New_Face(library_, file.c_str(), index, &face_) != 0) face_ = nullptr;
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;
  ~Font() {
    if (face_ != nullptr) FT_Done_Face(face_);
    if (library_ != nullptr) FT_Done_FreeType(library_);
  }

  /// In units of the size of the text.
  double advance(char32_t character) const {
    constexpr double kWithoutFont = 0.6;  // then nothing can be drawn either
    if (face_ == nullptr || FT_Load_Char(face_, character, FT_LOAD_NO_SCALE) != 0) return kWithoutFont;
    return static_cast<double>(face_->glyph->metrics.horiAdvance) / face_->units_per_EM;
  }

 private:
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

/// The bytes of the character that begins there.
std::size_t length_at(const std::string& text, std::size_t at) {
  std::size_t length = 1;
  while (at + length < text.size() && continues(text[at + length])) ++length;
  return length;
}

char32_t character_at(const std::string& text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const std::size_t length = length_at(text, at);
  if (length == 1 || length > 4) return first;
  char32_t value = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) value = value << 6U | (static_cast<unsigned char>(text[at + i]) & 0x3FU);
  return value;
}

}  // namespace

double printed_width(const std::string& text) {
  static const Font font;
  double width = 0;
  for (std::size_t at = 0; at < text.size(); at += length_at(text, at))
    width += font.advance(character_at(text, at)) * kTextSize;
  return width;
}

double widest_of(const std::vector<std::string>& texts) {
  double widest = 0;
  for (const std::string& text : texts) widest = std::max(widest, printed_width(text));
  return widest;
}

std::string shortened(const std::string& text, double width) {
  if (printed_width(text) <= width) return text;
  std::string kept = text;
  while (!kept.empty() && printed_width(kept + "...") > width) {
    while (kept.size() > 1 && continues(kept.back())) kept.pop_back();
    kept.pop_back();
  }
  return kept + "...";
}

std::vector<std::string> wrapped(const std::string& text, double width) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = lines.empty() ? word : lines.back() + " " + word;
    if (!lines.empty() && printed_width(longer) <= width)
      lines.back() = longer;
    else
      lines.push_back(shortened(word, width));
  }
  return lines;
}

}  // namespace corral
