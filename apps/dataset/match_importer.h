// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/dataset/match_layouts.h"
#include "kernel/correspondence_set.h"
#include "kernel/parallel.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/feature_matching.h"

namespace corral {

/// How matches of other programs are read.
struct MatchImportOptions {
  std::string resolution = "mean";       ///< pr: mean|source|target of the two clouds, or a length in mesh units
  std::optional<double> correct_within;  ///< mesh units; absent: 4 pr
  std::optional<int> first_index;        ///< of pairs of indices: 0 or 1; absent: as the indices show
  bool truth_is_inverse = false;
  MatchingOptions matching;  ///< of features
  ParallelFor parallel = one_by_one;
};

/// A pair as this program reads it.
struct ImportedPair {
  std::optional<CorrespondenceSet> matches;  ///< absent for a pair of clouds alone
  std::optional<RigidTransform> target_from_source;
  std::optional<int> correct;      ///< matches that are correct within the limit, where the truth is known
  std::vector<std::string> notes;  ///< what a user should know: a sentence each, no full stop
  std::string summary;             ///< "2236 matches, 205 correct within 0.3 (9.17 %)"
};

/// Reads pairs one after the other; what is measured on a cloud is kept for the next pair.
class MatchImporter {
 public:
  explicit MatchImporter(const MatchImportOptions& options) : options_(options) {}

  /// Throws    IoError: a file that cannot be read, no resolution; InvalidInput.
  ImportedPair read(const PairFiles& files);

 private:
  double spacing_of(const std::string& cloud);
  double resolution_of(const PairFiles& files);

  const MatchImportOptions options_;
  std::map<std::string, double> spacings_;  // by cloud
};

}  // namespace corral
