// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <ostream>
#include <string>

namespace corral {

/// A text that many records share, such as the name of an experiment: copies point to one string, which never changes.
class SharedText {
 public:
  SharedText() = default;
  SharedText(const std::string& text) : text_(text.empty() ? nullptr : std::make_shared<const std::string>(text)) {}
  SharedText(const char* text) : SharedText(std::string(text)) {}

  const std::string& str() const { return text_ ? *text_ : none(); }
  operator const std::string&() const { return str(); }
  bool empty() const { return !text_; }

 private:
  static const std::string& none() {
    static const std::string empty;
    return empty;
  }

  std::shared_ptr<const std::string> text_;  // null if empty
};

inline bool operator==(const SharedText& a, const SharedText& b) { return &a.str() == &b.str() || a.str() == b.str(); }
inline bool operator==(const SharedText& a, const std::string& b) { return a.str() == b; }
inline bool operator==(const std::string& a, const SharedText& b) { return a == b.str(); }
inline bool operator==(const SharedText& a, const char* b) { return a.str() == b; }
template <class Text>
bool operator!=(const SharedText& a, const Text& b) {
  return !(a == b);
}
inline std::string operator+(const std::string& a, const SharedText& b) { return a + b.str(); }
inline std::string operator+(const SharedText& a, const std::string& b) { return a.str() + b; }
inline std::ostream& operator<<(std::ostream& stream, const SharedText& text) { return stream << text.str(); }

}  // namespace corral
