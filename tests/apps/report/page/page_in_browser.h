// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "apps/report/page.h"
#include "io/disk/file.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"
#include "tests/apps/report/page/browser.h"
#include "tests/support/hostile_names.h"
#include "tests/support/meshes.h"
#include "tests/support/study_run.h"

namespace corral::testing {

inline const char* const kTitle = "Noise </script><script>alert('no')</script> \"&amp;\" \xc3\xa4";

/// What all tests share: a run, its page on disk, and a browser.
struct Desk {
  Desk() {
    ExperimentInfo experiment{"noise",
                              kTitle,
                              "a",
                              "spheres",
                              "noise_pr",
                              "noise (pr)",
                              {{"0.1", 0.1, 0.1}, {"0.2", 0.2, 0.2}, {"0.4", 0.4, 0.4}},
                              {"ss", "nnsr", "gc"},
                              {},
                              4,
                              1};
    std::vector<StudyCase> cases;
    for (const auto& [level, noise] : {std::pair<std::string, double>{"0.1", 0.1}, {"0.4", 0.4}})
      for (const int seed : {1, 2}) {
        const Mesh sphere = bumpy_sphere(4, static_cast<std::uint64_t>(seed));
        const RigidTransform truth = random_motion(sphere, static_cast<std::uint64_t>(seed));
        const Mesh noisy = add_gaussian_noise(sphere, noise * point_resolution(sphere.vertices), 3);
        cases.push_back({level, "Ball" + std::to_string(seed) + (noise < 0.2 ? "-low" : "-high"), sphere,
                         move_mesh(noisy, truth), truth});
      }
    cases.push_back({"0.2", "broken", {}, {}, {}});  // the level in the middle is a gap
    put_run(folder / "run", experiment, cases);
    run = read_study(folder / "run");
    PageOptions options;
    options.pairs_in_3d = 3;
    options.verdicts.emplace(2);
    options.verdicts->front().verdict = Verdict::Holds;
    options.verdicts->front().text = "<b>RANSAC</b> leads";
    const std::vector<StudyFolder> runs = {run};
    write_file(folder / "page.html", report_page(runs, results_of(runs), options));
    options.most_records = 13;  // of 23: the pairs at 0.1 and the one that failed
    options.pairs_in_3d = 1;
    write_file(folder / "sampled.html", report_page(runs, results_of(runs), options));
    const std::vector<StudyFolder> hostile = {with_hostile_names(run, "Ball1-low")};
    write_file(folder / "hostile.html", report_page(hostile, results_of(hostile), {}));
  }

  ScratchFolder folder;
  StudyFolder run;
  Browser browser{800, 600};
};

class PageInBrowser : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (missing().empty()) desk_ = std::make_unique<Desk>();
  }
  static void TearDownTestSuite() { desk_.reset(); }

  void SetUp() override {
    if (!desk_) GTEST_SKIP() << missing() << " is not installed";
    browser_ = &desk_->browser;
    run_ = desk_->run;
    browser_->open(desk_->folder / "page.html");
    wait_for_drawing();
  }
  void TearDown() override {
    if (!desk_) return;
    EXPECT_THAT(browser_->complaints(), ::testing::IsEmpty());
  }

  static std::string missing() {
    for (const char* script : {"three/three.min.js", "chart.js/chart.min.js"})
      if (!std::filesystem::exists(std::string("/usr/share/javascript/") + script)) return script;
    return Browser::is_installed() ? "" : "chromium";
  }

  nlohmann::json js(const std::string& expression) { return browser_->evaluate(expression); }

  /// The middle of what a selector finds, scrolled into the window.
  std::pair<double, double> place_of(const std::string& selector) {
    const nlohmann::json place = js("(() => { const e = document.querySelector('" + selector +
                                    "'); e.scrollIntoView({behavior: 'instant', block: 'center'}); const r = "
                                    "e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()");
    return {place[0], place[1]};
  }
  void click(const std::string& selector) {
    const auto [x, y] = place_of(selector);
    browser_->click(x, y);
  }
  /// Where a point of a panel is in the window.
  std::pair<double, double> point(int chart, int series, int column) {
    const nlohmann::json place =
        js("(() => { const c = panels.charts[" + std::to_string(chart) +
           "]; c.canvas.scrollIntoView({behavior: 'instant', block: 'center'}); const r = "
           "c.canvas.getBoundingClientRect(), p = c.getDatasetMeta(" +
           std::to_string(series) + ").data[" + std::to_string(column) + "]; return [r.x + p.x, r.y + p.y]; })()");
    return {place[0], place[1]};
  }
  void choose(const std::string& select, const std::string& value) {
    js("(() => { const s = document.getElementById('" + select + "'); s.value = '" + value +
       "'; s.dispatchEvent(new Event('change')); })()");
  }
  void wait_for_drawing() { js("new Promise(r => requestAnimationFrame(() => requestAnimationFrame(() => r(1))))"); }

  /// Pixels of the picture by what they show: the two surfaces, right and wrong matches; of the left or right half.
  nlohmann::json pixels(const std::string& half = "") {
    wait_for_drawing();
    return js(R"js((() => {
      const canvas = document.getElementById('view'), gl = canvas.getContext('webgl2') || canvas.getContext('webgl');
      const width = gl.drawingBufferWidth, height = gl.drawingBufferHeight, all = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, all);
      const counts = {source: 0, target: 0, right: 0, wrong: 0, sum: 0}, half = ')js" +
              half + R"js(';
      for (let i = 0; i < all.length; i += 4) {
        const x = i / 4 % width, r = all[i], g = all[i + 1], b = all[i + 2];
        const elsewhere = (half === 'left' && x >= width / 2) || (half === 'right' && x < width / 2);
        if (elsewhere || (r > 215 && g > 220 && b > 225)) continue;
        counts.sum = (counts.sum * 31 + r + 3 * g + 7 * b) % 1000003;
        if (g > r + 60 && g > b + 12) ++counts.right;
        else if (r > g + 60 && r > b + 80) ++counts.wrong;
        else if (b > r + 15) ++counts.source;
        else if (r > b + 8) ++counts.target;
      }
      return counts; })())js");
  }

  inline static std::unique_ptr<Desk> desk_;
  StudyFolder run_;
  Browser* browser_ = nullptr;
};

}  // namespace corral::testing
