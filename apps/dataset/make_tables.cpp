// SPDX-License-Identifier: MIT
#include "apps/dataset/make_tables.h"

#include <mutex>

#include "apps/dataset/set_folder.h"
#include "apps/pair/load_pair.h"
#include "apps/runtime/json.h"
#include "io/matches/matches_file.h"
#include "io/pairs/dataset_file.h"
#include "io/pose/transform_file.h"

namespace corral {
namespace {

std::string recipe(const MakeTablesOptions& options, const Dataset& set) {
  std::string text = "make tables\nmatching " + compact_json(to_json(options.matching)) + "\n";
  for (const DatasetPair& given : set.pairs) {
    const DatasetPair pair = set.with_paths(given);
    text += "pair " + pair.name;
    for (const std::string& file : pair.files())
      if (!file.empty()) text += " " + checksum(split_transform_name(file).file);
    text += "\n";
  }
  return text;
}

}  // namespace

int count_tables(const MakeTablesOptions& options) { return static_cast<int>(read_dataset(options.data).pairs.size()); }

void make_tables(const MakeTablesOptions& options, Progress& progress) {
  const Dataset set = read_dataset(options.data);
  MatchSettings matching = options.matching;
  matching.resolution = set.resolution, matching.threads = 1;
  const SetFolder folder(options.output, recipe(options, set));
  Dataset made = set;
  made.folder = options.output;
  made.name = set.name + "-tables";
  made.resolution = "mean";
  made.provenance = "tables of matches of " + set.name + ", by corral dataset make tables";
  std::mutex talking;
  options.parallel(static_cast<int>(set.pairs.size()), [&](int i) {
    const DatasetPair& given = set.pairs[static_cast<std::size_t>(i)];
    {
      const std::lock_guard<std::mutex> lock(talking);
      progress.begin(given.name);
    }
    DatasetPair pair{given.name, "", "", "", given.attributes, "matches/" + given.name + ".csv"};
    DatasetPair without_truth = given;
    without_truth.truth.clear(), without_truth.equal_truths.clear();
    if (!folder.has(pair.matches))
      folder.put(pair.matches, matches_text(load_pair(set, without_truth, matching).matches));
    const auto put_truth = [&](const std::string& truth, const std::string& file) {
      if (!folder.has(file)) folder.put(file, transform_text(read_transform(set.path(truth))));
      return file;
    };
    if (!given.truth.empty()) pair.truth = put_truth(given.truth, "truth/" + given.name + ".txt");
    for (std::size_t k = 0; k < given.equal_truths.size(); ++k)
      pair.equal_truths.push_back(
          put_truth(given.equal_truths[k], "truth/" + given.name + "-" + std::to_string(k + 1) + ".txt"));
    made.pairs[static_cast<std::size_t>(i)] = std::move(pair);
  });
  folder.finish(made);
}

}  // namespace corral
