// SPDX-License-Identifier: MIT
#include "apps/align/alignment_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/runtime/text_table.h"
#include "io/pose/transform_file.h"
#include "io/text/csv_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

const std::string& name_of(const std::vector<std::string>& names, int view) {
  return names[static_cast<std::size_t>(view)];
}

/// Whether a pair should be inspected: nothing confirms it, or the rest of the graph contradicts it.
bool is_doubtful(const AlignedPair& pair) { return pair.judgement.verdict != PairVerdict::Agrees; }

std::vector<std::vector<int>> parts_of(const AlignedViews& aligned) {
  std::vector<std::vector<int>> parts;
  for (std::size_t view = 0; view < aligned.part.size(); ++view) {
    const auto part = static_cast<std::size_t>(aligned.part[view]);
    if (part >= parts.size()) parts.resize(part + 1);
    parts[part].push_back(static_cast<int>(view));
  }
  return parts;
}

const char* origin(const AlignedPair& pair) { return pair.predicted ? "prediction" : "matches"; }

}  // namespace

std::string view_name(const std::string& path) { return std::filesystem::path(path).stem().string(); }

std::vector<ViewPair> read_view_pairs(const std::string& path, const std::vector<std::string>& names) {
  const CsvTable table = read_csv(path);
  const int source = table.column("source"), target = table.column("target"), transform = table.column("transform"),
            weight = table.column("weight");
  if (source < 0 || target < 0 || transform < 0)
    throw IoError(path, "header", "expected the columns source, target and transform");
  std::vector<ViewPair> pairs;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string place = "row " + std::to_string(row + 1);
    const auto cell = [&](int column) -> const std::string& {
      return table.rows[row][static_cast<std::size_t>(column)];
    };
    const auto view = [&](int column) {
      const auto found = std::find(names.begin(), names.end(), cell(column));
      if (found == names.end())
        throw IoError(path, place, "found the view '" + cell(column) + "', expected the name of a view being aligned");
      return static_cast<int>(found - names.begin());
    };
    ViewPair pair{view(source), view(target), {}, 1};
    if (pair.a == pair.b) throw IoError(path, place, "pairs " + cell(source) + " with itself, expected two views");
    if (weight >= 0) {
      const std::optional<double> number = parse_double(cell(weight));
      if (!number || !(*number > 0) || !std::isfinite(*number))
        throw IoError(path, place, "found the weight '" + cell(weight) + "', expected a number above 0");
      pair.weight = *number;
    }
    pair.b_from_a = read_transform((std::filesystem::path(path).parent_path() / cell(transform)).string());
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<std::string> pose_names(const std::string& path) {
  const CsvTable table = read_csv(path);
  const int transform = table.column("transform");
  std::vector<std::string> names;
  if (transform < 0) return names;
  for (const auto& row : table.rows)
    names.push_back((std::filesystem::path(path).parent_path() / row[static_cast<std::size_t>(transform)]).string());
  return names;
}

std::string pose_file(const std::string& folder, std::size_t number) {
  return (std::filesystem::path(folder) / "poses" / (std::to_string(number) + ".xf")).string();
}

std::vector<FileContent> alignment_files(const std::string& folder, const std::vector<std::string>& names,
                                         const AlignedViews& aligned) {
  std::vector<FileContent> files;
  for (std::size_t view = 0; view < names.size(); ++view)
    files.push_back({folder + "/" + names[view] + ".xf", transform_text(aligned.world_from_view[view])});
  CsvTable table{{"source", "target", "transform", "overlap", "median_pr", "in_front", "error_pr", "loops",
                  "closed_loops", "verdict", "origin", "confidence"},
                 {}};
  for (std::size_t i = 0; i < aligned.pairs.size(); ++i) {
    const AlignedPair& pair = aligned.pairs[i];
    files.push_back({pose_file(folder, i + 1), transform_text(pair.pose.b_from_a)});
    table.rows.push_back(
        {name_of(names, pair.pose.a), name_of(names, pair.pose.b), pose_file("", i + 1),
         to_text(pair.agreement.overlap), pair.agreement.median_pr ? to_text(*pair.agreement.median_pr) : "",
         to_text(pair.agreement.in_front), to_text(pair.judgement.error_pr), std::to_string(pair.judgement.loops),
         std::to_string(pair.judgement.closed_loops), to_text(pair.judgement.verdict), origin(pair),
         pair.confidence ? to_text(*pair.confidence) : ""});
  }
  files.push_back({folder + "/pairs.csv", csv_text(table)});
  return files;
}

std::string alignment_text(const std::vector<std::string>& names, const AlignedViews& aligned) {
  TextTable table({"source", "target", "overlap %", "median pr", "in front %", "off pr", "loops", "closed",
                   "confidence", "verdict"});
  std::string doubtful;
  for (const AlignedPair& pair : aligned.pairs) {
    const std::string &source = name_of(names, pair.pose.a), &target = name_of(names, pair.pose.b),
                      verdict = to_text(pair.judgement.verdict);
    table.add({source, target, fixed(100 * pair.agreement.overlap, 1), fixed(pair.agreement.median_pr, 2),
               fixed(100 * pair.agreement.in_front, 2), fixed(pair.judgement.error_pr, 2),
               std::to_string(pair.judgement.loops), std::to_string(pair.judgement.closed_loops),
               fixed(pair.confidence, 3), verdict});
    if (is_doubtful(pair)) doubtful += "doubtful: " + source + " -> " + target + ", " + verdict + "\n";
  }
  std::string text = aligned.pairs.empty() ? "no pair of views agrees\n" : table.str();
  text += doubtful;
  const std::vector<std::vector<int>> parts = parts_of(aligned);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    text += "part " + std::to_string(part + 1) + " of " + std::to_string(parts.size()) + ":";
    for (const int view : parts[part]) text += " " + name_of(names, view);
    text += "\n";
  }
  return text;
}

Json to_json(const std::vector<std::string>& names, const AlignedViews& aligned) {
  Json views = Json::array(), pairs = Json::array();
  for (std::size_t view = 0; view < names.size(); ++view)
    views.push_back({{"name", names[view]},
                     {"part", aligned.part[view]},
                     {"world_from_view", to_json(aligned.world_from_view[view])}});
  for (const AlignedPair& pair : aligned.pairs)
    pairs.push_back({{"source", name_of(names, pair.pose.a)},
                     {"target", name_of(names, pair.pose.b)},
                     {"verdict", to_text(pair.judgement.verdict)},
                     {"overlap", pair.agreement.overlap},
                     {"median_pr", json_or_null(pair.agreement.median_pr)},
                     {"in_front", pair.agreement.in_front},
                     {"error_pr", pair.judgement.error_pr},
                     {"loops", pair.judgement.loops},
                     {"closed_loops", pair.judgement.closed_loops},
                     {"origin", origin(pair)},
                     {"confidence", json_or_null(pair.confidence)},
                     {"target_from_source", to_json(pair.pose.b_from_a)}});
  return {{"converged", aligned.converged}, {"views", views}, {"pairs", pairs}};
}

}  // namespace corral
