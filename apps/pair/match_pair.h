// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/surface/descriptor.h"
#include "kernel/surface/feature_matching.h"
#include "kernel/surface/harris_mesh.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/mesh/topology.h"
#include "kernel/surface/normals.h"

namespace corral {

/// How one pair of surfaces becomes a table of matches. Defaults: the paper's.
struct MatchSettings {
  std::string resolution = "mean";  ///< pr of the pair: mean|source|target of the two, or a length in mesh units
  std::string detector = "harris";  ///< harris | harris-mesh | uniform
  double keypoint_radius_pr = 3;    ///< of harris; of the ball of harris-mesh; the spacing of uniform
  HarrisMeshOptions harris_mesh;    ///< its radius is keypoint_radius_pr
  double support_radius_pr = 15;    ///< of SHOT and its frame
  std::string normals = "mesh";  ///< mesh: to the side of the faces, else the sensor | origin: all towards the sensor
  std::vector<double> sensor = {0, 0, 0};  ///< x, y, z in mesh units
  std::string shot = "additive";           ///< additive | pcl | product
  MatchingOptions matching;
  int threads = 0;       ///< 0: as many as the machine has. Results do not depend on it
  bool inspect = false;  ///< look at the topology of the meshes too

  /// Throws InvalidInput for what is none of these.
  void validate() const;
};

/// What happened to one of the two surfaces.
struct SurfaceReport {
  int points = 0, faces = 0;
  std::optional<Topology> topology;  ///< if inspected
  double resolution = 0;             ///< its own, mesh units per pr
  int candidates = 0;                ///< what the keypoints were selected from
  int keypoints = 0;                 ///< those that the detector found
  int dropped_small_support = 0, dropped_no_frame = 0, dropped_no_histogram = 0;
  int descriptors = 0;  ///< keypoints less those dropped
};

struct StageCost {
  std::string stage;
  double time_ms = 0;         ///< wall time
  double peak_memory_mb = 0;  ///< the most that the process had held by the end of the stage
};

struct MatchReport {
  SurfaceReport source, target;
  double resolution = 0;                           ///< of the pair
  double keypoint_radius = 0, support_radius = 0;  ///< mesh units
  int matches = 0;
  std::vector<StageCost> stages;
  std::vector<std::string> hints;  ///< what to do about a count that is zero
};

struct MatchedPair {
  CorrespondenceSet matches;
  MatchReport report;
};

/// pr of a pair by the rule of MatchSettings, from that of each side. Throws InvalidInput if they are in different units.
double pair_resolution(const std::string& rule, double source, double target);

/// One of the two surfaces as the matching wants it. Depends on the mesh, the pr and the settings alone.
struct SurfaceFeatures {
  int candidates = 0, keypoints = 0;  ///< as in SurfaceReport
  Descriptors descriptors;
};

/// Runs a stage; what it is called with must be called once.
using StageRunner = std::function<void(const std::string& stage, const std::function<void()>& work)>;
inline void run_stage(const std::string&, const std::function<void()>& work) { work(); }

NormalOptions normal_options(const MatchSettings& settings);

/// keypoints -> frames and descriptors. `normals` by the options above, `resolution` in mesh units per pr. Throws InvalidInput.
SurfaceFeatures describe_surface(const Mesh& mesh, const Points& normals, double resolution,
                                 const MatchSettings& settings, const StageRunner& stage = run_stage);

/// The matches of two described surfaces. Throws InvalidInput.
CorrespondenceSet match_surfaces(const DescribedSurface& source, const DescribedSurface& target, double resolution,
                                 const MatchSettings& settings);

/// Called with what begins; may be empty.
using StageObserver = std::function<void(const std::string& stage)>;
int match_stages(const MatchSettings& settings);  ///< how many stages begin

/// normals, resolution -> keypoints, frames and descriptors of both surfaces -> matches. Throws InvalidInput.
MatchedPair match_pair(const Mesh& source, const Mesh& target, const MatchSettings& settings,
                       const StageObserver& observer = {});

}  // namespace corral
