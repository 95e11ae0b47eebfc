// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/pair/match_settings.h"
#include "kernel/correspondence_set.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/mesh/topology.h"

namespace corral {

/// What happened to one of the two surfaces.
struct SurfaceReport {
  int points = 0, faces = 0;
  std::optional<Topology> topology;           ///< if inspected
  double resolution = 0;                      ///< its own, mesh units per pr
  PointSpacing spacing;                       ///< what that is the mean of
  NormalGuide normals = NormalGuide::Origin;  ///< what the normals follow
  int candidates = 0;                         ///< what the keypoints were selected from
  int keypoints = 0;                          ///< those that the detector found
  int dropped_small_support = 0, dropped_no_frame = 0, dropped_no_histogram = 0;
  int descriptors = 0;  ///< keypoints minus those dropped
};

struct StageCost {
  std::string stage;
  double time_ms = 0;         ///< wall time
  double peak_memory_mb = 0;  ///< peak memory of the process up to the end of the stage
};

/// A length that the matching used.
struct UsedLength {
  std::string name;             ///< "harris.radius_pr"
  double pr = 0, usual_pr = 0;  ///< and its default
};

struct MatchReport {
  SurfaceReport source, target;
  double resolution = 0;            ///< of the pair
  std::vector<UsedLength> lengths;  ///< every option in pr of the detector and of the descriptor
  int matches = 0;
  std::vector<StageCost> stages;
  std::vector<std::string> warnings;  ///< of data that make results wrong
  std::string units;                  ///< why the sides may be in different units; empty if nothing speaks for it
  std::vector<std::string> hints;     ///< advice on counts that are zero and on normals
};

struct MatchedPair {
  CorrespondenceSet matches;
  MatchReport report;
};

/// Called with the name of a stage when it begins; may be empty.
using StageObserver = std::function<void(const std::string& stage)>;
int match_stages(const MatchSettings& settings);  ///< how many stages begin

/// One of the two surfaces, described for matching. Depends on the mesh, the pr and the settings alone.
struct SurfaceFeatures {
  int candidates = 0, keypoints = 0;  ///< as in SurfaceReport
  Descriptors descriptors;
};

/// Normals, keypoints, descriptors and frames of one surface. `resolution`: mesh units per pr. Throws InvalidInput.
SurfaceFeatures describe_surface(const Mesh& mesh, double resolution, const MatchSettings& settings);

/// The matches of two described surfaces. Throws InvalidInput.
CorrespondenceSet match_surfaces(const DescribedSurface& source, const DescribedSurface& target, double resolution,
                                 const MatchSettings& settings);

/// Where features of a surface are kept that several pairs share: gets the pr of the pair and what makes them.
using FeatureCache = std::function<SurfaceFeatures(double resolution, const std::function<SurfaceFeatures()>& make)>;

/// What a caller of match_pair may bring; all may be empty.
struct MatchHooks {
  StageObserver observer = {};
  FeatureCache source = {}, target = {};
};

/// normals, resolution -> keypoints, descriptors and frames of both surfaces -> matches. Throws InvalidInput.
MatchedPair match_pair(const Mesh& source, const Mesh& target, const MatchSettings& settings,
                       const MatchHooks& hooks = {});

}  // namespace corral
