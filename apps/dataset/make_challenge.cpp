// SPDX-License-Identifier: MIT
#include "apps/dataset/make_challenge.h"

#include "apps/dataset/challenge_table.h"
#include "apps/dataset/set_folder.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/random.h"

namespace corral {
namespace {

/// A table of the set: what it is drawn from, and how.
struct PlannedTable {
  const DatasetPair* real;
  std::string name;
  ChallengeOptions options;
  int repeat;
};

std::vector<PlannedTable> plan_tables(const MakeChallengeOptions& options, const Dataset& real) {
  std::vector<PlannedTable> tables;
  for (const DatasetPair& pair : real.pairs) {
    if (pair.matches.empty() || pair.truth.empty())
      throw IoError(
          real.path("pairs.csv"), "pair " + pair.name,
          "has no table of matches with a truth to draw from; 'corral dataset make tables' makes them from surfaces");
    for (const int size : options.sizes)
      for (const double ratio : options.inlier_ratios)
        for (const double noise : options.noises_pr)
          for (int repeat = 1; repeat <= options.repeats; ++repeat) {
            const std::string name = pair.name + "-m" + std::to_string(size) + "-r" + to_text(ratio) +
                                     (noise > 0 ? "-n" + to_text(noise) : "") +
                                     (options.repeats > 1 ? "-" + std::to_string(repeat) : "");
            tables.push_back(
                {&pair, name, {size, ratio, noise, options.threshold_pr, derive_seed(options.seed, name)}, repeat});
          }
  }
  return tables;
}

std::string recipe(const MakeChallengeOptions& options, const Dataset& real, const std::vector<PlannedTable>& tables) {
  std::string text =
      "make challenge\nseed " + std::to_string(options.seed) + "\nthreshold " + to_text(options.threshold_pr) + "\n";
  for (const DatasetPair& pair : real.pairs)
    text += "table " + pair.name + " " + checksum(real.path(pair.matches)) + " " +
            checksum(split_transform_name(real.path(pair.truth)).file) + "\n";
  for (const PlannedTable& table : tables) text += "drawn " + table.name + "\n";
  return text;
}

Dataset empty_set(const Dataset& real) {
  Dataset dataset;
  dataset.name = "challenge";
  dataset.units = real.units;
  dataset.provenance = "tables of chosen sizes and shares of correct matches, drawn from those of " + real.name +
                       " by corral dataset make challenge";
  dataset.licence = real.licence;
  dataset.citation = real.citation;
  dataset.attributes = {"table", "size", "ratio", "noise_pr", "repeat"};
  return dataset;
}

}  // namespace

int count_challenge(const MakeChallengeOptions& options) {
  const Dataset real = read_dataset(options.tables);
  return static_cast<int>(plan_tables(options, real).size());
}

void make_challenge(const MakeChallengeOptions& options, Progress& progress) {
  const Dataset real = read_dataset(options.tables);
  const std::vector<PlannedTable> tables = plan_tables(options, real);
  const SetFolder folder(options.output, recipe(options, real, tables));
  Dataset dataset = empty_set(real);
  for (const PlannedTable& table : tables) {
    const std::string truth = "truth/" + table.real->name + ".txt";
    const DatasetPair pair{
        table.name,
        "",
        "",
        truth,
        {table.real->name, std::to_string(table.options.matches), to_text(table.options.inlier_ratio),
         to_text(table.options.noise_pr), std::to_string(table.repeat)},
        "matches/" + table.name + ".csv"};
    dataset.pairs.push_back(pair);
    if (!folder.has(truth)) folder.put(truth, transform_text(read_transform(real.path(table.real->truth))));
  }
  const auto per_real = static_cast<int>(tables.size() / real.pairs.size());
  for (std::size_t first = 0; first < tables.size(); first += static_cast<std::size_t>(per_real)) {
    const DatasetPair& pair = *tables[first].real;
    progress.begin(pair.name, per_real);
    const CorrespondenceSet matches = read_matches(real.path(pair.matches));
    const RigidTransform truth = read_transform(real.path(pair.truth));
    options.parallel(per_real, [&](int i) {
      const PlannedTable& table = tables[first + static_cast<std::size_t>(i)];
      const std::string file = "matches/" + table.name + ".csv";
      if (folder.has(file)) return;
      try {
        folder.put(file, matches_text(draw_challenge(matches, truth, table.options)));
      } catch (const InvalidInput& error) {
        throw IoError(real.path("pairs.csv"), "pair " + pair.name, error.what());
      }
    });
  }
  folder.finish(dataset);
}

}  // namespace corral
