// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/parallel.h"
#include "kernel/surface/descriptors.h"
#include "kernel/surface/keypoints.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/table_entry.h"

namespace corral {

/// What a detector sees.
struct DetectorInput {
  const Mesh& mesh;
  double resolution;  ///< mesh units per pr
  const ParallelFor& parallel = one_by_one;
};

/// A detector with its options bound: a pure function of the surface.
struct ConfiguredDetector {
  std::function<Keypoints(const DetectorInput&)> detect;  ///< throws InvalidInput
  std::vector<OptionValue> options;
};
using Detector = TableEntry<ConfiguredDetector>;

/// What a descriptor sees.
struct DescriptorInput {
  const Points& vertices;    ///< V x 3, mesh units
  const Points& normals;     ///< V x 3, unit or zero
  const Indices& keypoints;  ///< vertices
  double resolution;         ///< mesh units per pr
  const ParallelFor& parallel = one_by_one;
};

/// A descriptor with its options bound.
struct ConfiguredDescriptor {
  std::function<Descriptors(const DescriptorInput&)> describe;  ///< throws InvalidInput
  std::vector<OptionValue> options;
};
struct Descriptor : TableEntry<ConfiguredDescriptor> {
  int size = 0;             ///< numbers of a feature
  bool has_frames = false;  ///< whether it brings local reference frames
};

/// Every detector and every descriptor, the paper's first. Names are unique over both and over the groupers.
const std::vector<Detector>& detectors();
const std::vector<Descriptor>& descriptors();

/// Throw InvalidInput for an unknown name, listing the known ones.
const Detector& find_detector(const std::string& name);
const Descriptor& find_descriptor(const std::string& name);

}  // namespace corral
