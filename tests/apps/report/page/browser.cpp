// SPDX-License-Identifier: MIT
#include "tests/apps/report/page/browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace corral::testing {
namespace {

using Json = nlohmann::json;

constexpr int kPatienceMs = 20000;

[[noreturn]] void become_chromium(const std::string& profile, int reads, int writes) {
  // It reads from 3 and writes to 4: out of their way first.
  const int in = ::fcntl(reads, F_DUPFD, 10), out = ::fcntl(writes, F_DUPFD, 10), nowhere = ::open("/dev/null", O_RDWR);
  ::dup2(in, 3);
  ::dup2(out, 4);
  for (const int standard : {0, 1, 2}) ::dup2(nowhere, standard);
  const std::string folder = "--user-data-dir=" + profile;
  ::execlp("chromium", "chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
           "--disable-background-networking", "--disable-component-update", "--disable-sync",
           "--enable-unsafe-swiftshader", "--remote-debugging-pipe", folder.c_str(), "about:blank",
           static_cast<char*>(nullptr));
  ::_exit(127);
}

std::string decoded(const std::string& base64) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char digit : base64) {
    if (digit == '=') break;
    bits = (bits << 6) | static_cast<unsigned>(kDigits.find(digit));
    if ((count += 6) >= 8) bytes += static_cast<char>((bits >> (count -= 8)) & 255U);
  }
  return bytes;
}

}  // namespace

bool Browser::is_installed() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

Browser::Browser(int width, int height) {
  ::signal(SIGPIPE, SIG_IGN);
  int down[2], up[2];
  if (::pipe2(down, O_CLOEXEC) != 0 || ::pipe2(up, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  process_ = ::fork();
  if (process_ == 0) {
    ::setpgid(0, 0);
    become_chromium(profile_.path(), down[0], up[1]);
  }
  ::close(down[0]);
  ::close(up[1]);
  to_browser_ = down[1];
  from_browser_ = up[0];
  const Json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}}).at("sessionId");
  for (const char* domain : {"Page.enable", "Runtime.enable", "Network.enable", "Log.enable"})
    call(domain, Json::object());
  resize(width, height);
}

Browser::~Browser() {
  session_.clear();
  try {
    call("Browser.close", Json::object());
  } catch (const std::exception&) {  // then it has to go without being asked
  }
  for (int wait = 0; wait < 100 && ::waitpid(process_, nullptr, WNOHANG) == 0; ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ::kill(-process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  ::close(to_browser_);
  ::close(from_browser_);
}

void Browser::resize(int width, int height) {
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

void Browser::open(const std::string& path) {
  is_loaded_ = false;
  call("Page.navigate", {{"url", "file://" + path}});
  while (!is_loaded_) receive();
}

Json Browser::evaluate(const std::string& expression) {
  const Json answer =
      call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (answer.contains("exceptionDetails")) throw std::runtime_error(expression + ": " + answer.dump());
  return answer.at("result").value("value", Json());
}

void Browser::mouse(const std::string& type, double x, double y, int buttons) {
  call("Input.dispatchMouseEvent", {{"type", type},
                                    {"x", x},
                                    {"y", y},
                                    {"button", type == "mouseMoved" && buttons == 0 ? "none" : "left"},
                                    {"buttons", buttons},
                                    {"clickCount", type == "mouseMoved" ? 0 : 1}});
}

void Browser::move(double x, double y) { mouse("mouseMoved", x, y, 0); }

void Browser::click(double x, double y) {
  move(x, y);
  mouse("mousePressed", x, y, 1);
  mouse("mouseReleased", x, y, 0);
}

void Browser::drag(double x0, double y0, double x1, double y1) {
  move(x0, y0);
  mouse("mousePressed", x0, y0, 1);
  mouse("mouseMoved", (x0 + x1) / 2, (y0 + y1) / 2, 1);
  mouse("mouseMoved", x1, y1, 1);
  mouse("mouseReleased", x1, y1, 0);
}

void Browser::press(const std::string& key) {
  Json event = {{"type", "keyDown"}, {"key", key}, {"code", key}};
  if (key == "Enter") event.update({{"text", "\r"}, {"windowsVirtualKeyCode", 13}});
  if (key == "Tab") event["windowsVirtualKeyCode"] = 9;
  call("Input.dispatchKeyEvent", event);
  event.erase("text");
  event["type"] = "keyUp";
  call("Input.dispatchKeyEvent", event);
}

void Browser::type(const std::string& text) { call("Input.insertText", {{"text", text}}); }

void Browser::screenshot(const std::string& path) {
  put_text(path, decoded(call("Page.captureScreenshot", {{"format", "png"}}).at("data")));
}

Json Browser::call(const std::string& method, const Json& parameters) {
  Json message = {{"id", ++calls_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump() + '\0';
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = ::write(to_browser_, text.data() + sent, text.size() - sent);
    if (count <= 0) throw std::runtime_error(method + ": the browser is gone");
    sent += static_cast<std::size_t>(count);
  }
  for (;;) {
    const Json answer = receive();
    if (answer.value("id", 0) != calls_) continue;
    if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
    return answer.at("result");
  }
}

/// The next message; events are noted on the way.
Json Browser::receive() {
  std::size_t end;
  while ((end = pending_.find('\0')) == std::string::npos) {
    pollfd waiting{from_browser_, POLLIN, 0};
    char buffer[65536];
    const ssize_t count = ::poll(&waiting, 1, kPatienceMs) > 0 ? ::read(from_browser_, buffer, sizeof buffer) : 0;
    if (count <= 0) throw std::runtime_error("the browser does not answer");
    pending_.append(buffer, static_cast<std::size_t>(count));
  }
  const Json message = Json::parse(pending_.substr(0, end));
  pending_.erase(0, end + 1);
  const std::string method = message.value("method", "");
  if (method == "Page.loadEventFired") is_loaded_ = true;
  const Json parameters = message.value("params", Json::object());
  if (method == "Runtime.exceptionThrown" ||
      (method == "Runtime.consoleAPICalled" && parameters.value("type", "") == "error"))
    complaints_.push_back(parameters.dump());
  if (method == "Log.entryAdded" && parameters.at("entry").value("level", "") == "error")
    complaints_.push_back(parameters.dump());
  if (method == "Network.requestWillBeSent") {
    const std::string url = parameters.at("request").at("url");
    if (url.rfind("file:", 0) != 0 && url.rfind("data:", 0) != 0 && url.rfind("blob:", 0) != 0)
      complaints_.push_back("asked for " + url);
  }
  return message;
}

}  // namespace corral::testing
