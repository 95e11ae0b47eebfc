// SPDX-License-Identifier: MIT
// The page opened from disk and used as a reader uses it: mouse, keys, and a look at what is drawn.
#include "tests/apps/report/page/page_in_browser.h"

namespace corral::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

TEST_F(PageInBrowser, PanelsShowTheSummary) {
  EXPECT_EQ(js("panels.charts.length"), 4);
  EXPECT_EQ(js("panels.charts.map(c => c.metric)"), Json({"precision", "recall", "f1", "success_5pr"}));
  double sum = 0;
  int count = 0;
  for (const StudyRecord& record : run_.records)
    if (record.level == "0.4" && record.method == "nnsr") sum += *record.recall, ++count;
  ASSERT_EQ(count, 2);
  const Json series = js("panels.charts[1].data.datasets[1]");
  EXPECT_EQ(series["label"], "nnsr");
  EXPECT_NEAR(series["data"][2], sum / 2, 1e-5);
  EXPECT_TRUE(series["data"][1].is_null());  // a gap, not 0
  EXPECT_EQ(js("panels.charts[1].data.labels"), Json({"0.1", "0.2", "0.4"}));
  EXPECT_EQ(js("new Set(panels.charts[0].data.datasets.slice(0, 3).map(d => d.borderColor)).size"), 3);
  EXPECT_EQ(js("new Set(panels.charts[0].data.datasets.slice(0, 3).map(d => d.pointStyle + d.rotation)).size"), 3);
  EXPECT_THAT(js("document.querySelector('#panels h3').textContent").get<std::string>(), HasSubstr(kTitle));
  EXPECT_THAT(js("document.querySelector('#panels .note').textContent").get<std::string>(),
              HasSubstr("3 failures"));  // of three groupers

  const auto [x, y] = point(1, 1, 2);
  browser_->move(x + 1, y + 1);
  wait_for_drawing();  // the panels answer with the next frame
  EXPECT_EQ(js("panels.charts[1].tooltip.opacity"), 1);
  const Json lines = js("panels.charts[1].tooltip.body.flatMap(b => b.lines)");
  EXPECT_THAT(lines.dump(), HasSubstr(js("'recall ' + panels.charts[1].data.datasets[1].data[2].toFixed(3)")));
  EXPECT_THAT(lines.dump(), HasSubstr("pairs 2, excluded 0, empty 0, failed 0"));

  click("#legend button:nth-of-type(2)");
  EXPECT_EQ(js("panels.charts.map(c => c.isDatasetVisible(1))"), Json({false, false, false, false}));
  EXPECT_EQ(js("document.querySelector('#legend button:nth-of-type(2)').ariaPressed"), "false");
  click("#legend button:nth-of-type(2)");
  EXPECT_EQ(js("panels.charts.map(c => c.isDatasetVisible(1))"), Json({true, true, true, true}));
  EXPECT_EQ(js("document.querySelectorAll('#findings-table tbody tr').length"), 2);
  EXPECT_EQ(js("document.querySelectorAll('#findings-table b').length"), 0);
  EXPECT_THAT(js("document.getElementById('run-facts').textContent").get<std::string>(),
              HasSubstr("corral evaluate noise"));
}

TEST_F(PageInBrowser, PanelsZoomAndAreReachedByKeys) {
  const auto [x0, y0] = point(0, 0, 0);
  const auto [x1, y1] = point(0, 0, 2);
  browser_->drag(x0 - 2, y0 - 20, x1 - 20, y0 + 30);
  const Json zoomed = js("[panels.charts[0].scales.y.min, panels.charts[0].scales.y.max]");
  EXPECT_GT(zoomed[0], 0.3);
  EXPECT_LT(zoomed[1].get<double>() - zoomed[0].get<double>(), 0.5);
  js("panels.charts[0].canvas.focus()");
  browser_->press("Escape");
  EXPECT_EQ(js("[panels.charts[0].scales.y.min, panels.charts[0].scales.y.max]"), Json({-0.03, 1.03}));

  browser_->press("ArrowRight");
  browser_->press("ArrowDown");
  EXPECT_THAT(js("byId('announcement').textContent").get<std::string>(), HasSubstr("NNSR at 0.1, precision"));
  browser_->press("ArrowRight");
  EXPECT_THAT(js("byId('announcement').textContent").get<std::string>(), HasSubstr("NNSR at 0.2, pairs 0"));
  browser_->press("ArrowRight");
  browser_->press("Enter");
  EXPECT_EQ(js("[pairView.state.level, byId('left-method').value]"), Json({"0.4", "nnsr"}));
}

TEST_F(PageInBrowser, TheTableSortsFiltersAndOpensPairs) {
  const auto column = [&](int number) {
    return js("[...document.querySelectorAll('#records-table tbody tr')].map(r => r.cells[" + std::to_string(number) +
              "].textContent)");
  };
  EXPECT_EQ(js("document.querySelectorAll('#records-table tbody tr').length"), 23);  // 4 pairs x 5, and 3 that failed
  const int f1 = js("[...document.querySelectorAll('#records-table th')].findIndex(h => h.textContent === 'F1')");
  const std::string header = "#records-table th:nth-of-type(" + std::to_string(f1 + 1) + ") button";
  const auto values = [&] {
    std::vector<double> numbers;
    const Json cells = column(f1);
    for (std::size_t i = 0; i < 20; ++i) numbers.push_back(std::stod(cells[i].get<std::string>()));
    for (std::size_t i = 20; i < 23; ++i) EXPECT_EQ(cells[i], "\xe2\x80\x93");  // what is absent is last, either way
    return numbers;
  };
  click(header);
  std::vector<double> sorted = values();
  EXPECT_TRUE(std::is_sorted(sorted.begin(), sorted.end()));
  EXPECT_LT(sorted.front(), sorted.back());
  browser_->press("Enter");  // the header has the focus
  sorted = values();
  EXPECT_TRUE(std::is_sorted(sorted.rbegin(), sorted.rend()));
  EXPECT_EQ(js("document.querySelectorAll('#records-table th')[" + std::to_string(f1) + "].ariaSort"), "descending");

  click("#filter-pair");
  browser_->type("bALL2-h");
  EXPECT_EQ(column(2), Json({"Ball2-high", "Ball2-high", "Ball2-high", "Ball2-high", "Ball2-high"}));
  choose("filter-method", "gc");
  EXPECT_EQ(column(2).size(), 1u);
  js("document.querySelector('#records-table td button').focus()");
  browser_->press("Enter");
  EXPECT_EQ(js("document.activeElement.id"), "pair-title");
  EXPECT_EQ(js("document.querySelectorAll('#records-table tr.chosen').length"), 1);
  // Three of four pairs are in 3D: one that is not says so.
  click("#reset-filters");
  const Json absent = js("records.findIndex(r => r.selection && !pairView.has(r))");
  js("document.querySelectorAll('#records-table tbody tr')[0]");
  EXPECT_GE(absent, 0);
  choose("filter-method", "gc");
  js("[...document.querySelectorAll('#records-table tbody tr')].find(r => r.cells[2].textContent === records[" +
     absent.dump() + "].pair).click()");
  EXPECT_THAT(js("byId('pair-note').textContent").get<std::string>(), HasSubstr("not among the 3 pairs"));
  EXPECT_EQ(js("byId('pair-view').hidden"), true);
  choose("filter-outcome", "failed");
  choose("filter-method", "");
  EXPECT_EQ(column(2), Json({"broken", "broken", "broken"}));
}

TEST_F(PageInBrowser, OfALargeStudyItSaysThatItShowsASample) {
  EXPECT_EQ(js("[isSampled, byId('sample-note').hidden]"), Json({false, true}));
  const Json counts =
      js("[byId('summary').textContent, [...document.querySelectorAll('.note')].map(n => n.textContent)]");
  browser_->open(desk_->folder / "sampled.html");
  EXPECT_EQ(js("byId('sample-note').hidden"), false);
  EXPECT_THAT(js("byId('sample-note').textContent").get<std::string>(),
              AllOf(HasSubstr("carries 13 of 23 records"), HasSubstr("those of 3 of 5 pairs"), HasSubstr("at random")));
  EXPECT_THAT(js("byId('records-count').textContent").get<std::string>(),
              AllOf(HasSubstr("13 rows of 13"), HasSubstr("(a sample of 23)")));
  const Json sampled =
      js("[byId('summary').textContent, [...document.querySelectorAll('.note')].map(n => n.textContent)]");
  EXPECT_EQ(sampled[1], counts[1]) << "what stands under the titles is counted over all records";
  EXPECT_THAT(sampled[0].get<std::string>(), AllOf(HasSubstr("23 records"), HasSubstr("1 pair in 3D")));
  js("document.querySelector('#records-table td button').click()");
  js("panels.charts[0].options.onClick({}, [{datasetIndex: 1, index: 2}])");  // a point none of whose pairs is there
}

TEST_F(PageInBrowser, APointLeadsToItsPairInThreeDimensions) {
  const auto [x, y] = point(0, 0, 2);  // precision of ss at 0.4
  browser_->click(x, y);
  wait_for_drawing();
  const std::string pair = js("pairView.state.scene.pair");
  EXPECT_THAT(pair, HasSubstr("-high"));
  EXPECT_EQ(js("[byId('filter-level').value, byId('filter-method').value, byId('left-method').value]"),
            Json({"0.4", "ss", "ss"}));
  EXPECT_EQ(js("document.querySelectorAll('#records-table tbody tr').length"), 2);

  for (const char* method : {"ss", "gc", "nnsr"}) {  // what is drawn is what was scored
    choose("left-method", method);
    for (const StudyRecord& record : run_.records) {
      if (record.pair != pair || record.method != method) continue;
      const Json drawn =
          js("Object.fromEntries(pairView.halves()[0].three.children.filter(c => c.name).map(c => [c.name, "
             "c.userData.count]))");
      EXPECT_EQ(drawn.value("right", 0), *record.correct);
      EXPECT_EQ(drawn.value("wrong", 0), *record.selected - *record.correct);
      EXPECT_EQ(drawn.value("missed", 0), *record.true_matches - *record.correct);
    }
  }
  // Where the threshold is what is swept, that of the level decides.
  js("data.experiments[0].attribute = 'threshold_pr'; pairView.show(records.find(r => r.pair === '" + pair +
     "' && r.method === 'oracle'))");
  EXPECT_EQ(js("pairView.halves()[0].groups.right.length"),
            js("[...pairView.state.scene.distance].filter((d, i) => d <= 0.4 && "
               "pairView.state.scene.kept.oracle[i]).length"));
  EXPECT_LT(js("pairView.halves()[0].groups.right.length"),
            js("pairView.state.scene.kept.oracle.filter(Boolean).length"));
  js("data.experiments[0].attribute = 'noise_pr'");
  choose("left-method", "ss");
  const Json all = pixels();
  for (const char* kind : {"source", "target"}) EXPECT_GT(all[kind], 10000) << kind;
  EXPECT_GT(all["right"], 1000);
  EXPECT_GT(all["wrong"], 200);
  click("#show-right");
  const Json without_right = pixels();
  EXPECT_LT(without_right["right"], all["right"].get<int>() / 20);
  EXPECT_GE(without_right["wrong"], all["wrong"]);
  click("#show-wrong");
  EXPECT_LT(pixels()["wrong"], all["wrong"].get<int>() / 20);
}

TEST_F(PageInBrowser, TurnsComparesAndLaysOnEachOther) {
  choose("right-method", "gc");
  const Json left = pixels("left"), right = pixels("right");
  EXPECT_GT(left["source"], 5000);
  EXPECT_GT(right["source"], 5000);
  EXPECT_NE(left["right"], right["right"]);  // two groupers kept other matches
  EXPECT_THAT(js("byId('left-caption').textContent + byId('right-caption').textContent").get<std::string>(),
              ::testing::AllOf(HasSubstr("SS "), HasSubstr("GC ")));
  const auto [x, y] = place_of("#view");
  browser_->drag(x - 300, y, x - 150, y + 40);
  const Json turned = pixels("right");
  EXPECT_NE(turned["sum"], right["sum"]);  // one camera for both
  EXPECT_GT(turned["source"], 3000);
  browser_->press("0");
  EXPECT_EQ(pixels("right"), right);
  browser_->press("ArrowLeft");
  EXPECT_NE(pixels("right")["sum"], right["sum"]);

  choose("right-method", "");
  choose("layout", "aligned");
  choose("stage", "truth");
  EXPECT_GT(pixels()["source"], 1000);
  // Decoded places and the true pose give the residuals that were measured on the full meshes.
  const Json worst = js(R"js((() => {
    const s = pairView.state.scene, t = s.truth;
    let worst = 0;
    for (let i = 0; i < s.matches; ++i) {
      const [x, y, z] = s.p.subarray(3 * i, 3 * i + 3);
      const apart = [0, 1, 2].map(r => t.slice(4 * r, 4 * r + 4)
          .reduce((sum, v, k) => sum + v * [x, y, z, 1][k], -s.q[3 * i + r]));
      worst = Math.max(worst, Math.abs(Math.hypot(...apart) / s.resolution - s.distance[i]));
    }
    return worst; })())js");
  EXPECT_LT(worst, 0.01);
  // The surfaces do lie on each other: their boxes on the screen are the same up to the noise.
  const Json box =
      js("(() => { const [a, b] = pairView.halves()[0].three.children.filter(c => c.isMesh).map(c => { "
         "c.geometry.computeBoundingBox(); return c.geometry.boundingBox; }); return [a.min.distanceTo(b.min), "
         "a.max.distanceTo(b.max), a.min.distanceTo(a.max)]; })()");
  EXPECT_LT(box[0], 0.05 * box[2].get<double>());
  EXPECT_LT(box[1], 0.05 * box[2].get<double>());

  // Without a truth nothing is right or wrong: what was kept is drawn in a colour of its own.
  js("Object.assign(data.scenes[1], {residuals: null, truth: null})");
  choose("scene", js("byId('scene').options[1].value"));
  choose("layout", "beside");
  const Json drawn =
      js("[pairView.halves()[0].groups.kept.length, pairView.state.scene.kept[byId('left-method').value]."
         "filter(Boolean).length, byId('left-caption').textContent]");
  EXPECT_GT(drawn[0], 0);
  EXPECT_EQ(drawn[0], drawn[1]);
  EXPECT_THAT(drawn[2].get<std::string>(), HasSubstr("not judged without a truth"));
  const Json unjudged = pixels();
  EXPECT_LT(unjudged["right"].get<int>() + unjudged["wrong"].get<int>(), 100);
  EXPECT_GT(unjudged["target"], 5000);
}

TEST_F(PageInBrowser, NamesAreNeverMarkup) {
  const Json tags = js("document.querySelectorAll('script').length");
  browser_->open(desk_->folder / "hostile.html");
  wait_for_drawing();
  EXPECT_EQ(js("typeof window.hacked"), "undefined");
  EXPECT_EQ(js("document.querySelectorAll('img, svg, i').length"), 0);
  EXPECT_EQ(js("document.querySelectorAll('script').length"), tags);
  EXPECT_THAT(js("document.querySelector('#records-table').textContent").get<std::string>(),
              HasSubstr("<img src=x onerror=window.hacked=1>"));
  Browser other{800, 600};  // of its own: that it complains is asked for
  other.open(desk_->folder / "hostile.html");
  other.evaluate("document.body.append(Object.assign(element('script'), {textContent: 'window.hacked = 1'}))");
  EXPECT_EQ(other.evaluate("typeof window.hacked"), "undefined") << "a script without the nonce has run";
  EXPECT_THAT(other.complaints(), ElementsAre(HasSubstr("Content Security Policy")));
}

}  // namespace
}  // namespace corral::testing
