// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/io/scratch.h"

namespace corral::testing {

/// A headless Chromium with one page, driven through its DevTools pipe by the mouse and the keys that a user has.
class Browser {
 public:
  static bool is_installed();

  Browser(int width, int height);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void resize(int width, int height);  ///< of the window, in pixels
  void open(const std::string& path);  ///< a file; returns when it is loaded
  /// The value of a JavaScript expression. Throws std::runtime_error with what the page throws.
  nlohmann::json evaluate(const std::string& expression);
  void move(double x, double y);  ///< of the mouse, in pixels of the window
  void click(double x, double y);
  void drag(double x0, double y0, double x1, double y1);
  void press(const std::string& key);  ///< such as ArrowRight, Enter, Tab
  void type(const std::string& text);
  void screenshot(const std::string& path);  ///< as PNG

  /// Errors of the page and its console, and what it asked a network for.
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json receive();
  void mouse(const std::string& type, double x, double y, int buttons);

  ScratchFolder profile_;
  pid_t process_ = 0;
  int to_browser_ = -1, from_browser_ = -1, calls_ = 0;
  std::string session_, pending_;
  bool is_loaded_ = false;
  std::vector<std::string> complaints_;
};

}  // namespace corral::testing
