// SPDX-License-Identifier: MIT
// What to use, and what was found, as the page shows it.
#include "tests/apps/report/page/page_in_browser.h"

namespace corral::testing {
namespace {

using Json = nlohmann::json;

TEST_F(PageInBrowser, WhatToUseNamesTheGroupersOfEveryDataSet) {
  EXPECT_EQ(js("choices.charts.length"), 1);
  EXPECT_EQ(js("choices.charts[0].data.datasets.length"), 3 + 1) << "the groupers and the line that joins the front";
  EXPECT_EQ(js("document.querySelectorAll('#choice-sets h3').length"), 1);
  const Json rows =
      js("[...document.querySelectorAll('#choice-sets .panels tbody tr')].map(r => r.cells[0].textContent)");
  EXPECT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows.back(), "all correct matches");
  EXPECT_EQ(js("document.querySelectorAll('#choice-sets .cells tbody tr').length"),
            js("new Set(data.choices[0].cells.map(c => c.correct)).size"));
  EXPECT_EQ(js("document.querySelectorAll('#found-table tbody tr').length"), js("data.found.length"));
  EXPECT_EQ(js("document.getElementById('found').hidden"), js("data.found.length === 0"));
}

}  // namespace
}  // namespace corral::testing
