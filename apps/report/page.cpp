// SPDX-License-Identifier: MIT
#include "apps/report/page.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "apps/claims/claim_report.h"
#include "apps/report/page_sample.h"
#include "apps/report/page_scenes.h"
#include "apps/report/page_tables.h"
#include "apps/runtime/embedded_files.h"
#include "apps/runtime/json.h"
#include "apps/study/content_store.h"
#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {

const EmbeddedFiles& embedded_page();  // the files of apps/report/page

namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// Escapes what could end a script element or open another in it; in a string of JSON or JavaScript the meaning is the
/// same.
std::string json_in_html(const Json& json) { return replaced(compact_json(json), "<", "\\u003c"); }
std::string script_in_html(const std::string& script, const std::string& nonce) {
  return "<script nonce=\"" + nonce + "\">\n" + replaced(replaced(script, "</script", "<\\/script"), "<!--", "<\\!--") +
         "\n</script>\n";
}

std::string text_in_html(const std::string& text) { return replaced(replaced(text, "&", "&amp;"), "<", "&lt;"); }

/// The template with each {{name}} replaced, not recursively.
std::string filled(const std::string& html, const std::map<std::string, std::string>& parts) {
  std::string text;
  std::size_t at = 0;
  for (std::size_t open = html.find("{{"); open != std::string::npos; open = html.find("{{", at)) {
    const std::size_t close = html.find("}}", open);
    text += html.substr(at, open - at) + parts.at(html.substr(open + 2, close - open - 2));
    at = close + 2;
  }
  return text + html.substr(at);
}

std::vector<std::string> libraries(const std::string& folder) {
  std::vector<std::string> scripts;
  for (const auto& [name, package] : {std::pair<std::string, std::string>{"three/three.min.js", "libjs-three"},
                                      {"three/examples/js/controls/TrackballControls.js", "libjs-three"},
                                      {"chart.js/chart.min.js", "libjs-chart.js"}}) {
    const std::string path = (std::filesystem::path(folder) / name).string();
    if (!std::filesystem::exists(path))
      throw IoError(path, "", "is missing and the page needs it: install Debian's package " + package);
    scripts.push_back(read_file(path));
  }
  return scripts;
}

}  // namespace

std::string report_page(const std::vector<StudyFolder>& runs, const std::vector<StudyResults>& studies,
                        const PageOptions& options) {
  const EmbeddedFiles& files = embedded_page();
  std::vector<std::string> scripts = libraries(options.scripts);
  for (const char* name :
       {"data.js", "zoom.js", "panels.js", "choices.js", "surfaces.js", "pair_view.js", "records.js", "report.js"})
    scripts.push_back(files.at(name));
  std::map<std::string, std::string> parts = {{"title", text_in_html(options.title)},
                                              {"style", files.at("report.css")}};
  const std::vector<SceneChoice> scenes = choose_scenes(runs, options.pairs_in_3d);
  Json data = {{"title", options.title},
               {"verdicts", options.verdicts ? claims_json(*options.verdicts) : Json(nullptr)}};
  data.update(page_tables(studies, sample_records(runs, scenes, options.most_records)));
  std::size_t bytes = files.at("report.html").size() + json_in_html(data).size();
  for (const auto& [name, text] : parts) bytes += text.size();
  for (const std::string& script : scripts) bytes += script_in_html(script, content_hash("")).size();
  data.update(page_scenes(runs, scenes, options.most_bytes - std::min(options.most_bytes, bytes)));
  parts["data"] = json_in_html(data);
  // Only what knows the nonce runs; it follows from all data, so that nothing in them can know it.
  const std::string nonce = parts["nonce"] = content_hash(parts["title"] + parts["data"]);
  for (const std::string& script : scripts) parts["scripts"] += script_in_html(script, nonce);
  return filled(files.at("report.html"), parts);
}

}  // namespace corral
