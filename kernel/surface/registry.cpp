// SPDX-License-Identifier: MIT
#include "kernel/surface/registry.h"

#include "kernel/surface/fpfh.h"
#include "kernel/surface/harris.h"
#include "kernel/surface/harris_mesh.h"
#include "kernel/surface/iss.h"
#include "kernel/surface/shot.h"
#include "kernel/surface/uniform.h"

namespace corral {
namespace {

struct Card {
  const char *name, *title, *principle, *citation;
};

template <class Options>
Detector entry(const Card& card, Keypoints (*detect)(const DetectorInput&, const Options&)) {
  const auto configure = [who = std::string(card.name), detect](const OptionOverrides& overrides) {
    const auto options = parse_options<Options>(overrides, who);
    return ConfiguredDetector{[=](const DetectorInput& input) { return detect(input, options); },
                              describe_options(options)};
  };
  return {card.name, card.title, card.principle, card.citation, describe_options(Options{}), configure};
}

template <class Options>
Descriptor entry(const Card& card, Descriptors (*describe)(const DescriptorInput&, const Options&), int size,
                 bool has_frames) {
  const auto configure = [who = std::string(card.name), describe](const OptionOverrides& overrides) {
    const auto options = parse_options<Options>(overrides, who);
    return ConfiguredDescriptor{[=](const DescriptorInput& input) { return describe(input, options); },
                                describe_options(options)};
  };
  return {
      {card.name, card.title, card.principle, card.citation, describe_options(Options{}), configure}, size, has_frames};
}

}  // namespace

const std::vector<Detector>& detectors() {
  static const std::vector<Detector> table = {
      entry<HarrisOptions>({"harris", "Harris 3D", "normals vary in all directions", "sipiran2011harris"},
                           [](const DetectorInput& in, const HarrisOptions& options) {
                             return detect_harris(in.mesh.vertices, in.resolution, options, in.parallel);
                           }),
      entry<HarrisMeshOptions>(
          {"harris-mesh", "Harris 3D on the faces", "a fitted quadratic bends both ways", "sipiran2011harris"},
          [](const DetectorInput& in, const HarrisMeshOptions& options) {
            return detect_harris_mesh(in.mesh, in.resolution, options);
          }),
      entry<IssOptions>({"iss", "Intrinsic shape signatures (ISS)",
                         "neighbours spread in three directions, differently in each", "zhong2009iss"},
                        [](const DetectorInput& in, const IssOptions& options) {
                          return detect_iss(in.mesh, in.resolution, options, in.parallel);
                        }),
      entry<UniformOptions>({"uniform", "Uniform sampling", "one vertex of every cube of a lattice, a control", ""},
                            [](const DetectorInput& in, const UniformOptions& options) {
                              return detect_uniform(in.mesh.vertices, in.resolution, options);
                            }),
  };
  return table;
}

const std::vector<Descriptor>& descriptors() {
  static const std::vector<Descriptor> table = {
      entry<ShotOptions>(
          {"shot", "SHOT", "histograms of normals over a grid in the local frame", "tombari2010shot"},
          [](const DescriptorInput& in, const ShotOptions& options) {
            return describe_shot(in.vertices, in.normals, in.keypoints, in.resolution, options, in.parallel);
          },
          kShotSize, true),
      entry<FpfhOptions>(
          {"fpfh", "Fast point feature histograms (FPFH)", "how normals turn between neighbours", "rusu2009fpfh"},
          [](const DescriptorInput& in, const FpfhOptions& options) {
            return describe_fpfh(in.vertices, in.normals, in.keypoints, in.resolution, options, in.parallel);
          },
          kFpfhSize, false),
  };
  return table;
}

const Detector& find_detector(const std::string& name) { return find_entry(detectors(), "detector", name); }

const Descriptor& find_descriptor(const std::string& name) { return find_entry(descriptors(), "descriptor", name); }

}  // namespace corral
