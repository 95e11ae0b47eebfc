// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/pair/confidence_signals.h"
#include "grouping/grouper.h"
#include "kernel/correspondence_set.h"
#include "kernel/options.h"
#include "kernel/parallel.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/scan/view_triangulation.h"

namespace corral {

/// A pose that a grouper proposed, refined, and what speaks for it.
struct ProposedPose {
  std::string method;  ///< the first grouper that proposed it
  RigidTransform target_from_source;
  int support = 0;   ///< matches within 5 pr
  double score = 0;  ///< SurfaceCoverage within 4 pr; of a table, the mean of 1 - (e/5 pr)^2 over all matches, 0 beyond
  SurfaceEvidence surfaces;
};

/// The poses of a pair without a truth.
struct Registration {
  std::vector<ProposedPose> poses;           ///< the best first, farther than 5 pr apart; empty if there is none
  std::optional<ConfidenceSignals> signals;  ///< of the best
  std::vector<std::string> methods;          ///< the groupers that answered
  OtherPoses others;                         ///< for the signals of any pose of the pair
};

/// The surfaces beside a table of matches.
struct RegisteredSurfaces {
  const Mesh &source, &target;
  std::optional<ViewOptions> source_sensor, target_sensor;  ///< of those that are views of which it is known
};

/// A grouper that proposes poses, with options that serve that.
struct Proposer {
  std::string method;
  OptionOverrides options;
};

/// Each finds pairs that the others miss; the cheap ones first.
const std::vector<Proposer>& proposers();
double proposers_memory(int matches);  ///< peak bytes of any of them

/// What it finds; nothing if it needs a column that the table lacks, or more than 4 GB. Its own pose, if it has none, is the fit
/// to its selection.
std::optional<GroupingResult> propose(const Proposer& proposer, const CorrespondenceSet& matches);

/// Called when a step of registration_steps() begins, with its name.
using RegistrationObserver = std::function<void(const std::string& step)>;
int registration_steps();

/// Registers a pair: the poses of several groupers, their runners-up too, are refined over the matches within 5 pr and over all
/// matches; those under which the surfaces cover each other best are refined on the whole surfaces; poses that a sensor
/// contradicts (more than 1.5 % of the points in front of what it saw) are dropped, unless all are; the best is that under which
/// the surfaces cover each other best. Of a table alone, the score over all matches decides.
///
/// Signals   of the best pose (confidence_signals.h).
/// Source    the choice is that of [chen2023sc2pcr]; the signals are ours.
/// Returns   no pose if no grouper has one. Deterministic for any number of threads.
Registration register_pair(const CorrespondenceSet& matches, const std::optional<RegisteredSurfaces>& surfaces,
                           const ParallelFor& parallel = one_by_one, const RegistrationObserver& observer = {});

}  // namespace corral
