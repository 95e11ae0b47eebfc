// SPDX-License-Identifier: MIT
// The scoreboard opened from disk, in wide and narrow windows, by the mouse and by keys alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "apps/scoreboard/site.h"
#include "tests/apps/report/page/browser.h"

namespace corral::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

const char* const kHostile = "</script><script>alert('no')</script>\"&";

BoardRow row_of(const std::string& method, int rank, double success) {
  BoardRow row;
  row.method = method;
  row.rank = rank;
  row.all = {success, 20, success - 0.1, success + 0.1};
  row.by_share.assign(kCorrectShares.size(), std::nullopt);
  row.by_share.front() = SuccessShare{success / 2, 10, 0, 1};
  row.precision = 1 - success, row.median_ms = 100 * success;
  return row;
}

/// Boards with so many methods, of which the first is the best and the last applies to no table.
std::vector<Board> boards_of(int boards, int methods) {
  std::vector<Board> all;
  for (int b = 0; b < boards; ++b) {
    Board board{"noise", "set" + std::to_string(b), b == 0 ? kHostile : "Noise", 20, {row_of("oracle", 0, 0.95)}};
    for (int m = 0; m < methods; ++m)
      board.rows.push_back(row_of("method" + std::to_string(m), m + 1, 0.9 - 0.8 * m / methods));
    board.rows.back().rank = 0, board.rows.back().all = {}, board.rows.back().median_ms.reset();
    all.push_back(board);
  }
  return all;
}

class ScoreboardInBrowser : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (Browser::is_installed()) browser_ = std::make_unique<Browser>(1200, 800);
  }
  static void TearDownTestSuite() { browser_.reset(); }

  void SetUp() override {
    if (!browser_) GTEST_SKIP() << "chromium is not installed";
    browser_->resize(1200, 800);
    FactsByMethod facts;
    facts["method0"] = {kHostile, kHostile, "", "MIT", "local frames", "seeded", 0.5, 5, {"scale"}, true};
    write(boards_of(2, 4), facts);
  }
  void TearDown() override {
    if (!browser_) return;
    EXPECT_THAT(browser_->complaints(), IsEmpty());
  }

  void write(const std::vector<Board>& boards, const FactsByMethod& facts) {
    for (const FileContent& file : scoreboard_site(boards, facts, folder_ / ".")) write_file(file.path, file.content);
  }
  void open(const std::string& page) { browser_->open(folder_ / page); }
  Json js(const std::string& expression) { return browser_->evaluate(expression); }
  /// The names in a column, from the top; of the methods if none is named.
  Json order() { return js("[...document.querySelectorAll('tbody tr')].map(r => r.cells[1].textContent)"); }
  std::string sorted_by() {
    return js(
        "[...document.querySelectorAll('th[aria-sort]')].filter(h => h.ariaSort !== 'none').map(h => h.textContent + ' "
        "' + "
        "h.ariaSort).join()");
  }
  void choose(const std::string& header) {
    const Json place =
        js("(() => { const b = [...document.querySelectorAll('th button')].find(b => b.textContent === '" + header +
           "'); b.scrollIntoView({behavior: 'instant', inline: 'center'}); const r = b.getBoundingClientRect(); "
           "return [r.x + r.width / 2, r.y + r.height / 2]; })()");
    browser_->click(place[0], place[1]);
  }
  void expect_fits() {
    EXPECT_LE(js("document.documentElement.scrollWidth"), js("document.documentElement.clientWidth"));
    EXPECT_EQ(js("[...document.querySelectorAll('h1, p, dd')].filter(e => e.scrollWidth > e.clientWidth + 1).length"),
              0);
  }

  static std::unique_ptr<Browser> browser_;
  const ScratchFolder folder_;
};
std::unique_ptr<Browser> ScoreboardInBrowser::browser_;

TEST_F(ScoreboardInBrowser, ColumnsAreSortedByTheMouse) {
  open("noise-set1.html");
  EXPECT_EQ(order(), Json({"all correct matches", "method0", "method1", "method2", "method3"}));
  choose("success");
  EXPECT_EQ(sorted_by(), "success descending");
  EXPECT_EQ(order(), Json({"all correct matches", "method0", "method1", "method2", "method3"}));
  choose("success");
  EXPECT_EQ(sorted_by(), "success ascending");
  EXPECT_EQ(order(), Json({"method2", "method1", "method0", "all correct matches", "method3"}))
      << "without a share: last";
  choose("time ms");
  EXPECT_EQ(order().back(), "method3");
  choose("method");
  EXPECT_EQ(order(), Json({"all correct matches", "method0", "method1", "method2", "method3"}));
}

TEST_F(ScoreboardInBrowser, KeysAloneReachEverything) {
  open("index.html");
  const auto tab_to = [&](const std::string& text) {
    for (int presses = 0; presses < 60; ++presses) {
      browser_->press("Tab");
      if (js("document.activeElement.textContent") != text) continue;
      EXPECT_NE(js("getComputedStyle(document.activeElement).outlineStyle"), "none") << text;
      return;
    }
    ADD_FAILURE() << text << " is not reached";
  };
  const auto enter = [&](const std::string& page) {
    browser_->press("Enter");
    for (int wait = 0;
         wait < 200 &&
         js("document.readyState === 'complete' ? location.pathname : ''").get<std::string>().find(page) ==
             std::string::npos;
         ++wait)
      js("new Promise(r => setTimeout(r, 10))");
    EXPECT_THAT(js("location.pathname").get<std::string>(), HasSubstr(page));
  };
  tab_to("Noise, set1");
  enter("noise-set1.html");
  tab_to("recall");
  browser_->press("Enter");
  EXPECT_EQ(sorted_by(), "recall descending");
  tab_to("method0");
  enter("method-method0.html");
  tab_to("All boards");
  enter("index.html");
}

TEST_F(ScoreboardInBrowser, NarrowWindowsScrollTheTableAlone) {
  for (const int width : {1200, 360}) {
    browser_->resize(width, 700);
    for (const char* page :
         {"index.html", "noise-set1.html", "noise-set0.html", "method-method0.html", "method-method3.html"}) {
      SCOPED_TRACE(page + std::string(" at ") + std::to_string(width));
      open(page);
      expect_fits();
    }
  }
}

TEST_F(ScoreboardInBrowser, NamesAreNoMarkup) {
  for (const char* page : {"noise-set0.html", "method-method0.html"}) {
    open(page);
    EXPECT_THAT(js("document.querySelector('h1').textContent").get<std::string>(), HasSubstr(kHostile)) << page;
    EXPECT_EQ(js("document.scripts.length"), 1) << page;
  }
  EXPECT_THAT(js("document.querySelector('dl').textContent").get<std::string>(), HasSubstr("breaks: scale"));
}

TEST_F(ScoreboardInBrowser, HoldsManyMethodsOnManySets) {
  write(boards_of(10, 200), {});
  open("index.html");
  EXPECT_EQ(js("document.querySelectorAll('tbody tr').length"), 10);
  const auto begin = std::chrono::steady_clock::now();
  open("noise-set9.html");
  choose("time ms");
  EXPECT_EQ(order().size(), 201u);
  EXPECT_EQ(order().front(), "all correct matches");
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  RecordProperty("opened_and_sorted_ms", std::to_string(taken.count()));
}

}  // namespace
}  // namespace corral::testing
