// SPDX-License-Identifier: MIT
#include "apps/report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/report/figure/method_style.h"
#include "apps/report/page_scenes.h"
#include "io/disk/file.h"
#include "kernel/surface/mesh/perturbation.h"
#include "tests/io/scratch.h"
#include "tests/support/hostile_names.h"
#include "tests/support/meshes.h"
#include "tests/support/study_run.h"

namespace corral::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A small run, made once: two pairs at one level, one at another that failed, a level without a pair.
class Page : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/share/javascript/three/three.min.js") ||
        !std::filesystem::exists("/usr/share/javascript/chart.js/chart.min.js"))
      GTEST_SKIP() << "libjs-three or libjs-chart.js is not installed";
    const ExperimentInfo experiment{"noise",
                                    "Noise <b> & \"more\" </script><script>alert(1)</script>",
                                    "a",
                                    "spheres",
                                    "noise_pr",
                                    "noise (pr)",
                                    {{"0.1", 0.1, 0.1}, {"0.2", 0.2, 0.2}, {"0.3", 0.3, 0.3}},
                                    {"ss", "gc"},
                                    {},
                                    4,
                                    1};
    std::vector<StudyCase> cases;
    for (const int seed : {1, 2}) {
      const Mesh sphere = bumpy_sphere(3, static_cast<std::uint64_t>(seed));
      const RigidTransform truth = random_motion(sphere, 5);
      cases.push_back({"0.1", "pair" + std::to_string(seed), sphere, move_mesh(sphere, truth), truth});
    }
    cases.push_back({"0.2", "broken", {}, {}, {}});
    put_run(folder_ / "run", experiment, cases);
  }

  std::vector<StudyFolder> runs() const { return {read_study(folder_ / "run")}; }
  std::string page(const PageOptions& options = {}) const {
    const std::vector<StudyFolder> found = runs();
    return report_page(found, results_of(found), options);
  }
  Json data() const { return data_of(page()); }

  static Json data_of(const std::string& page) {
    const std::string open = "<script type=\"application/json\" id=\"data\">";
    const std::size_t begin = page.find(open) + open.size();
    return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  }

  ScratchFolder folder_;
};

TEST_F(Page, SameRunsSameBytes) { EXPECT_EQ(page(), page()); }

TEST_F(Page, HoldsTheMeansOfTheSummaryAndGapsWhereThereAreNone) {
  const Json means = data()["experiments"][0]["means"];
  ASSERT_EQ(means.size(), 12u);  // three levels, two methods and the bounds
  EXPECT_THAT(means[0]["level"], "0.1");
  EXPECT_EQ(means[0]["pairs"], 2);
  EXPECT_EQ(means[4]["level"], "0.2");
  EXPECT_EQ(means[4]["failed"], 1);
  EXPECT_TRUE(means[4]["precision"].is_null());
  EXPECT_TRUE(means[8]["f1"].is_null());
  const std::vector<StudyFolder> found = runs();
  const SummaryRow row = results_of(found).at(0).summary.at(0);
  for (const SummaryCell& cell : summary_cells(row)) {
    ASSERT_TRUE(means[0].contains(cell.name)) << cell.name;
    if (cell.value) {
      EXPECT_NEAR(means[0][cell.name].get<double>(), *cell.value, 1e-4 * *cell.value) << cell.name;
    }
  }
}

TEST_F(Page, NamesTheMeasuresThatItShows) {
  const Json page = data();
  for (const Json& shown : page["measures"]) {
    const std::string name = shown["name"];
    EXPECT_EQ(shown["title"], measure(name).title);
    EXPECT_EQ(page["records"].contains(name), shown["record"].get<bool>()) << name;
    EXPECT_TRUE(!shown["panel"] || page["experiments"][0]["means"][0].contains(name)) << name;
  }
  EXPECT_EQ(page["measures"].size(), measures_with(kHeadline | kOnPage).size());
}

TEST_F(Page, ARunOfTimesHasATableOfItsOwn) {
  std::vector<StudyFolder> found = runs();
  found[0].experiments[0].attribute = "table_size";
  for (StudyRecord& record : found[0].records) {
    record.time_ms = std::nullopt;
    if (record.level == "0.2" && record.method == "gc") record.time_ms = 0.25;
  }
  const Json means = data_of(report_page(found, results_of(found)))["experiments"][0]["means"];
  ASSERT_EQ(means.size(), 1u);
  EXPECT_EQ(means[0], Json({{"level", "0.2"},
                            {"method", "gc"},
                            {"runs", 1},
                            {"median_ms", 0.25},
                            {"mean_ms", 0.25},
                            {"lower_quartile_ms", 0.25},
                            {"upper_quartile_ms", 0.25}}));
}

TEST_F(Page, SaysOfEachRecordWhetherItIsExcluded) {
  std::vector<StudyFolder> found = runs();
  found[0].experiments[0].least_true_matches = 1000000;
  found[0].records[0].true_matches.reset();
  const Json page = data_of(report_page(found, results_of(found)));
  for (std::size_t row = 0; row < found[0].records.size(); ++row)
    EXPECT_EQ(page["records"]["excluded"][row], found[0].records[row].matches ? 1 : 0) << row;
}

TEST_F(Page, HoldsEveryRecord) {
  const Json page = data();
  const std::vector<StudyRecord> records = runs()[0].records;
  const auto word = [&](const char* column, std::size_t row) {
    return page["words"][page["records"][column][row].get<std::size_t>()].get<std::string>();
  };
  ASSERT_EQ(page["records"]["pair"].size(), records.size());
  for (std::size_t row = 0; row < records.size(); ++row) {
    EXPECT_EQ(word("pair", row), records[row].pair);
    EXPECT_EQ(word("method", row), records[row].method);
    EXPECT_EQ(word("status", row), to_text(records[row].status));
    EXPECT_EQ(page["records"]["selected"][row].is_null(), !records[row].selected.has_value());
    if (records[row].refined.mean_error_pr) {
      EXPECT_NEAR(page["records"]["refined_mean_error_pr"][row], *records[row].refined.mean_error_pr, 1e-4);
    }
  }
}

TEST_F(Page, ALargerStudyIsSampledAndCountedWhole) {
  PageOptions options;
  options.most_records = 6;  // of 10: two pairs with two groupers and two bounds each, and one that failed
  const Json whole = data(), sampled = data_of(page(options));
  EXPECT_EQ(whole["totals"], Json({{"records", 10}, {"pairs", 3}, {"exclusions", 0}, {"failed", 2}}));
  EXPECT_EQ(whole["experiments"][0]["failed"], 2);
  EXPECT_EQ(whole["records"]["pair"].size(), 10u);
  EXPECT_EQ(sampled["records"]["pair"].size(), 4u) << "the first scene; no half of a pair";
  EXPECT_EQ(sampled["totals"], whole["totals"]);
  EXPECT_EQ(sampled["experiments"], whole["experiments"]);
}

TEST_F(Page, HasAsManyPairsInThreeDimensionsAsFit) {
  const std::size_t with_both = page().size();
  PageOptions options;
  options.most_bytes = with_both + 1000;
  EXPECT_EQ(data_of(page(options))["scenes"].size(), 2u);
  options.most_bytes = with_both - 1000;
  const std::string with_one = page(options);
  EXPECT_LE(with_one.size(), options.most_bytes);
  EXPECT_EQ(data_of(with_one)["scenes"].size(), 1u);
  EXPECT_EQ(data_of(with_one)["meshes"].size(), 2u);
  options.most_bytes = 1000;  // tables and records always come
  EXPECT_EQ(data_of(page(options))["scenes"].size(), 0u);
  EXPECT_EQ(data_of(page(options))["meshes"].size(), 0u);
  EXPECT_EQ(data_of(page(options))["records"]["pair"].size(), 10u);
}

TEST_F(Page, MethodsLookAsInTheFigures) {
  const Json styles = data()["styles"];
  EXPECT_EQ(styles.size(), 4u);
  for (const auto& [method, style] : method_styles({"ss", "gc", "oracle", "baseline"}))
    EXPECT_EQ(styles[method],
              Json({{"label", style.label}, {"color", style.color}, {"point", style.point}, {"dash", style.dash}}));
}

TEST_F(Page, NothingFromTheDataIsMarkup) {
  PageOptions options;
  options.title = "<i>T</i> & \xff {{data}}";
  options.verdicts = {ClaimVerdict()};
  options.verdicts->front().text = "</script><img src=x>";
  const std::string page = this->page(options);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_THAT(page, HasSubstr("<title>&lt;i>T&lt;/i> &amp; \xff {{data}}</title>"));
  EXPECT_EQ(data_of(page)["verdicts"][0]["statement"], "</script><img src=x>");
  EXPECT_EQ(data_of(page)["experiments"][0]["title"], runs()[0].experiments[0].title);
  int opened = 0, closed = 0;
  for (std::size_t at = 0; (at = page.find("<script", at)) != std::string::npos; ++at) ++opened;
  for (std::size_t at = 0; (at = page.find("</script", at)) != std::string::npos; ++at) ++closed;
  EXPECT_EQ(opened, 12);  // the data, three of the libraries, eight of ours
  EXPECT_EQ(closed, 12);
}

// A study is a folder that anyone may have written.
TEST_F(Page, NamesOfAnyKindAreText) {
  const std::string plain = page();
  for (const std::string& name : hostile_names()) {
    std::vector<StudyFolder> found = runs();
    ExperimentInfo& info = found[0].experiments[0];
    info.levels[0].label = info.methods[0] = info.axis = info.dataset = name;
    for (StudyRecord& record : found[0].records) {
      record.dataset = record.scene = name;
      if (record.method == "ss") record.method = name;
      if (record.level == "0.1") record.level = name;
      if (record.pair == "pair1") record.pair = name;
      record.status.cause = name;
    }
    const std::string page = report_page(found, results_of(found), {});
    const auto tags = [](const std::string& text) { return std::count(text.begin(), text.end(), '<'); };
    EXPECT_EQ(tags(page), tags(plain)) << name.substr(0, 100);
    if (name[0] != '\xff') {  // bytes that are no UTF-8 are replaced
      EXPECT_EQ(data_of(page)["experiments"][0]["axis"], name);
    }
  }
}

TEST_F(Page, OnlyItsOwnScriptsRun) {
  const std::string page = this->page();
  const std::string open = "script-src 'nonce-";
  const std::size_t at = page.find(open) + open.size();
  const std::string nonce = page.substr(at, page.find('\'', at) - at);
  EXPECT_EQ(nonce.size(), 32u);
  EXPECT_THAT(page, HasSubstr("<meta http-equiv=\"Content-Security-Policy\""));
  EXPECT_EQ(page.find("unsafe"), page.find("unsafe", page.find("<script nonce"))) << "none in the policy";
  int with_nonce = 0;
  for (std::size_t next = 0; (next = page.find("<script nonce=\"" + nonce + "\">", next)) != std::string::npos; ++next)
    ++with_nonce;
  EXPECT_EQ(with_nonce, 11);
  PageOptions other;
  other.title = "another";
  EXPECT_EQ(this->page(other).find(nonce), std::string::npos);
}

TEST_F(Page, SaysWhatIsMissing) {
  PageOptions options;
  options.scripts = folder_ / "nowhere";
  EXPECT_THAT(io_error_of([&] { page(options); }), HasSubstr("libjs-three"));
}

TEST_F(Page, APairThatCannotBeDrawnIsSaidSo) {
  const std::string mesh = runs()[0].pairs.at("spheres/pair1").target;
  const std::string selections = folder_ / "run/selections/pair2.csv";
  put_text(selections, "source_keypoint,target_keypoint,residual_pr,ss\n1,100000,0,1\n");
  remove_file(mesh);
  const Json scenes = data()["scenes"];
  ASSERT_EQ(scenes.size(), 2u);
  std::string problems;
  for (const Json& scene : scenes) problems += scene["problem"].get<std::string>() + "\n";
  EXPECT_THAT(problems, HasSubstr(mesh));
  EXPECT_THAT(problems, HasSubstr("vertex 100000 of a mesh of 642 vertices"));
}

/// A run of a level whose pairs have these F1 for one method, and another level that shares the first pair.
StudyFolder run_of(const std::vector<std::optional<double>>& f1) {
  StudyFolder run;
  run.experiments = {{"e", "", "", "d", "", "", {{"1", 1, 1}, {"2", 2, 2}}, {"gc"}, {}, 4, 1}};
  for (std::size_t i = 0; i < f1.size(); ++i)
    for (const char* method : {"gc", "oracle"}) {
      StudyRecord record;
      record.experiment = "e";
      record.dataset = "d";
      record.level = "1";
      record.pair = "p" + std::to_string(i);
      record.method = method;
      record.f1 = f1[i];
      if (method == std::string("oracle")) record.f1 = 1 - f1[i].value_or(0) * 3;  // must not count
      record.selection = "s" + std::to_string(i);
      run.records.push_back(record);
      if (i > 0) continue;
      record.level = "2";
      run.records.push_back(record);
    }
  return run;
}

std::vector<std::string> names_of(const std::vector<SceneChoice>& scenes) {
  std::vector<std::string> names;
  for (const SceneChoice& scene : scenes) names.push_back(scene.pair);
  return names;
}

TEST(ChooseScenes, MedianThenWorstThenBestThenTheOthers) {
  const std::vector<StudyFolder> runs = {run_of({0.1, 0.9, 0.5, 0.2, 0.8})};
  // p0 is all that level 2 has.
  EXPECT_THAT(names_of(choose_scenes(runs, 9)), ElementsAre("p2", "p0", "p1", "p3", "p4"));
  EXPECT_THAT(names_of(choose_scenes(runs, 3)), ElementsAre("p2", "p0", "p1"));
  EXPECT_TRUE(choose_scenes(runs, 0).empty());
  EXPECT_THAT(names_of(choose_scenes({run_of({0.3, std::nullopt, 0.3})}, 9)), ElementsAre("p0", "p1", "p2"));
}

TEST(ChooseScenes, OfEveryRunAndNoneWithoutSelections) {
  std::vector<StudyFolder> runs = {run_of({0.5}), run_of({0.5})};
  EXPECT_EQ(choose_scenes(runs, 9).size(), 2u);
  for (StudyRecord& record : runs[0].records) record.selection = {};
  ASSERT_EQ(choose_scenes(runs, 9).size(), 1u);
  EXPECT_EQ(choose_scenes(runs, 9)[0].run, 1);
}

}  // namespace
}  // namespace corral::testing
