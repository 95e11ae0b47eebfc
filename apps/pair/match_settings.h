// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/runtime/json.h"
#include "kernel/surface/feature_matching.h"
#include "kernel/surface/local_frames.h"
#include "kernel/surface/normals.h"
#include "kernel/surface/registry.h"

namespace corral {

/// How one pair of surfaces becomes a table of matches. Defaults: the paper's, but for the side of the normals (there Origin).
struct MatchSettings {
  std::string resolution = "mean";  ///< pr of the pair: mean|source|target of the two, or a length in mesh units
  std::string detector = "harris", descriptor = "shot";  ///< names in their tables
  OptionsByName options;                                 ///< of those two, beside their defaults
  LocalFrames frames = LocalFrames::Shot;
  NormalSide normals = NormalSide::Auto;
  std::vector<double> sensor = {};  ///< x, y, z in mesh units; empty: not known
  MatchingOptions matching;
  int threads = 0;       ///< 0: as many as the machine has. Results do not depend on it
  bool inspect = false;  ///< inspect the topology of the meshes too

  /// What is a choice or a flag; command line, experiment files and records are made from it.
  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"frames", "", "shot", "local reference frames of the matches; 3DHV and SI need them"},
          self.frames);
    visit(
        OptionField{
            "normals", "", "origin",
            "side that normals point to. auto: towards the sensor if it is given, else as the faces, the "
            "normals or the sensor in the file say, else towards the origin; mesh: as the faces say, of a cloud "
            "towards the sensor; file: as the normals in the file say; origin: all towards the sensor"},
        self.normals);
    MatchingOptions::visit_fields(self.matching, visit);
  }

  /// Throws InvalidInput for what is none of these, or an option of what is not in use.
  void validate() const;

  /// The names whose options take part: the detector, the descriptor, and SHOT where the frames are its own.
  std::vector<std::string> in_use() const;
  OptionOverrides options_of(const std::string& name) const;

  ConfiguredDetector configured_detector() const { return find_detector(detector).configure(options_of(detector)); }
  ConfiguredDescriptor configured_descriptor() const {
    return find_descriptor(descriptor).configure(options_of(descriptor));
  }
  NormalOptions normal_options() const;
};

/// All that results depend on, in effect: defaults stand there too.
Json to_json(const MatchSettings& settings);

/// Every option of a name that is a detector or a descriptor, with its value under these settings. Empty for another name.
std::vector<OptionValue> surface_options(const MatchSettings& settings, const std::string& name);

/// The length of the detector that decides how many keypoints there are: the first of its options in pr.
OptionValue keypoint_length(const MatchSettings& settings);

/// pr of a pair by the rule of MatchSettings, from that of each side. Throws InvalidInput if they are in different units;
/// `remark` ends its message.
double pair_resolution(const std::string& rule, double source, double target, const std::string& remark = "");

}  // namespace corral
