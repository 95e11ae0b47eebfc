// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace corral {

/// Two surfaces of a data set, or a table of matches between them, or both. Paths are as written in pairs.csv: absolute, or
/// relative to the folder of the set.
struct DatasetPair {
  std::string name;                     ///< unique in its set; letters, digits, and . _ + - only
  std::string source, target;           ///< mesh files; both empty if the pair is a table alone
  std::string truth;                    ///< transform file, target_from_source; empty if it is not known
  std::vector<std::string> attributes;  ///< one cell for each of Dataset::attributes; empty where unknown
  std::string matches = {};             ///< table of matches; empty if the surfaces are to be matched
  std::vector<std::string> equal_truths =
      {};  ///< further transform files, each as right as `truth`: of a symmetric object

  bool has_surfaces() const { return !source.empty(); }
  /// source, target, truth, matches (each empty where it names none), then the equal truths.
  std::vector<std::string> files() const;
};

/// A data set: a folder with dataset.toml and pairs.csv, and the files that they name.
struct Dataset {
  std::string folder;
  std::string name;                     ///< such as "b3r"
  std::string kind = "pairs";           ///< retrieval | recognition | registration | pairs
  std::string units = "unknown";        ///< of the meshes: mm | m | unknown
  std::string resolution = "mean";      ///< pr of a pair: mean|source|target of the two, or a length in mesh units
  std::string provenance, licence;      ///< in words
  std::vector<std::string> citation;    ///< one work each
  std::vector<std::string> attributes;  ///< further columns of pairs.csv, such as noise_pr, overlap, model, scene
  std::vector<DatasetPair> pairs;

  std::string path(const std::string& file) const;  ///< of a file of the set, from the working directory
  DatasetPair with_paths(DatasetPair pair) const;   ///< its files so
};

/// The file that a command that makes a set writes first, so that an unfinished set can be told from none.
constexpr char kRecipeName[] = "recipe.txt";

/// Reads the manifest, but none of the files that it names.
///
///   dataset.toml   name (required), kind, units, resolution, provenance, licence, citation (a list)
///   pairs.csv      pair,source,target,truth, then matches (optional) and any attributes; several truths that are equally right
///                  stand in the one cell, between semicolons
///
/// Throws IoError naming file and place: an unknown or doubled key, a wrong kind, no pairs, a doubled or empty pair name,
/// one side without the other, neither surfaces nor matches, an unfinished set.
Dataset read_dataset(const std::string& folder);

/// The two files as text; reading them back gives the same set.
std::string dataset_toml_text(const Dataset& dataset);
std::string pairs_csv_text(const Dataset& dataset);

/// A cell of an attribute; empty if the set has no such column.
std::string attribute_text(const Dataset& dataset, const DatasetPair& pair, const std::string& attribute);
/// The same as a number; absent if the cell is empty or there is no such column. Throws IoError if it is no finite number.
std::optional<double> attribute_number(const Dataset& dataset, const DatasetPair& pair, const std::string& attribute);

/// The scene of a pair, for means over scenes: its cell in the column `scene`, or `object` where the set has no such column.
std::string scene_of(const Dataset& dataset, const DatasetPair& pair);

}  // namespace corral
