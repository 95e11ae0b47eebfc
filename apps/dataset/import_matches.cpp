// SPDX-License-Identifier: MIT
#include "apps/dataset/import_matches.h"

#include <algorithm>
#include <filesystem>

#include "apps/dataset/set_folder.h"
#include "apps/runtime/text_table.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

std::string recipe_of(const ImportFolderOptions& options, const std::vector<PairFiles>& pairs) {
  std::string text =
      "import matches\nfolder " + fs::absolute(options.folder).lexically_normal().string() + "\nresolution " +
      options.resolution + "\ncorrect_within " + (options.correct_within ? to_text(*options.correct_within) : "4 pr") +
      "\nfirst_index " + (options.first_index ? std::to_string(*options.first_index) : "auto") + "\ntruth_inverse " +
      (options.truth_is_inverse ? "true" : "false") + "\nmutual " + (options.matching.mutual ? "true" : "false") + "\n";
  for (const PairFiles& pair : pairs) text += pair.name + " " + pair.matches + "\n";
  return text;
}

/// The names of all attributes, in the order in which pairs have them.
std::vector<std::string> attribute_names(const std::vector<PairFiles>& pairs) {
  std::vector<std::string> names;
  for (const PairFiles& pair : pairs)
    for (const auto& attribute : pair.attributes)
      if (std::find(names.begin(), names.end(), attribute.first) == names.end()) names.push_back(attribute.first);
  return names;
}

std::string absolute(const std::string& path) {
  return path.empty() ? "" : fs::absolute(path).lexically_normal().string();
}

}  // namespace

std::vector<std::string> import_match_folder(const ImportFolderOptions& options, Progress& progress) {
  std::vector<PairFiles> pairs = find_match_pairs(options.folder, options.layout);
  const SetFolder set(options.output, recipe_of(options, pairs));
  Dataset dataset;
  dataset.name = file_word(fs::absolute(options.output).lexically_normal().string());
  dataset.kind = "registration";
  dataset.resolution = options.resolution;
  dataset.provenance = "matches of other programs, read from " + absolute(options.folder);
  dataset.attributes = attribute_names(pairs);
  dataset.attributes.insert(dataset.attributes.end(), {"rows", "inlier_ratio"});
  MatchImporter importer(options);
  std::vector<std::string> lines;
  for (PairFiles& files : pairs) {
    progress.begin(files.name, 1.0 / static_cast<double>(pairs.size()));
    const ImportedPair pair = importer.read(files);
    for (const std::string& note : pair.notes) lines.push_back("note: " + note);
    lines.push_back(files.name + ": " + pair.summary);
    DatasetPair row;
    row.name = files.name;
    if (!files.source.empty() && !files.target.empty()) {  // one cloud alone is of no use to a pair
      row.source = absolute(files.source);
      row.target = absolute(files.target);
    }
    if (pair.target_from_source) {
      row.truth = "truth/" + files.name + ".txt";
      set.put(row.truth, transform_text(*pair.target_from_source));
    }
    if (pair.matches) {
      row.matches = "matches/" + files.name + ".csv";
      set.put(row.matches, matches_text(*pair.matches));
      files.attributes.push_back({"rows", std::to_string(pair.matches->size())});
    }
    if (pair.correct)
      files.attributes.push_back({"inlier_ratio", fixed(100.0 * *pair.correct / pair.matches->size(), 2)});
    for (const std::string& name : dataset.attributes) {
      const auto place = std::find_if(files.attributes.begin(), files.attributes.end(),
                                      [&](const auto& attribute) { return attribute.first == name; });
      row.attributes.push_back(place == files.attributes.end() ? "" : place->second);
    }
    dataset.pairs.push_back(std::move(row));
  }
  set.finish(dataset);
  return lines;
}

}  // namespace corral
