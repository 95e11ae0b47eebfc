// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernel/correspondence_set.h"
#include "kernel/parallel.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/mesh/mesh.h"
#include "kernel/surface/scan/view_triangulation.h"

namespace corral {

/// A pose that a grouper proposed, refined, and what speaks for it.
struct ProposedPose {
  std::string method;  ///< the first grouper that proposed it
  RigidTransform target_from_source;
  int support = 0;                 ///< matches within 5 pr
  double score = 0;                ///< SurfaceCoverage within 4 pr; of a table, the mean of 1 - (e/5 pr)^2 over all matches, 0 beyond
  double overlap = 0, rms_pr = 0;  ///< of the dense refinement (SurfaceFit); 0 for a table
  double moved_pr = 0;             ///< mean displacement of the matched source points by the dense refinement
  double in_front = 0;             ///< share of points in front of what the other sensor saw, where sensors are known
};

/// What tells a right pose from a wrong one without a truth; all finite, larger is safer.
constexpr std::size_t kSignals = 9;
constexpr std::array<const char*, kSignals> kSignalNames = {
    "support", "support share", "lead over other poses", "certainty of the fit", "agreement of groupers",
    "overlap", "residual",      "free space",            "stability"};
using ConfidenceSignals = std::array<double, kSignals>;

/// The poses of a pair without a truth.
struct Registration {
  std::vector<ProposedPose> poses;             ///< the best first, farther than 5 pr apart; empty if there is none
  std::optional<ConfidenceSignals> signals;    ///< of the best
  std::vector<std::string> methods;            ///< the groupers that answered
};

/// The surfaces beside a table of matches.
struct RegisteredSurfaces {
  const Mesh &source, &target;
  std::optional<ViewOptions> sensor;  ///< of both, if they are views of which it is known
};

/// Called when a step of registration_steps() begins, with its name.
using RegistrationObserver = std::function<void(const std::string& step)>;
int registration_steps();

/// Registers a pair: the poses of several groupers, their runners-up too, are refined over the matches within 5 pr and over all
/// matches; those under which the surfaces cover each other best are refined on the whole surfaces; poses that a sensor
/// contradicts (more than 1.5 % of the points in front of what it saw) are dropped, unless all are; the best is that under which
/// the surfaces cover each other best. Of a table alone, the score over all matches decides.
///
/// Signals   (S: the n' matches within 5 pr of the best pose T, m = the fewer distinct points of the two sides, n all matches)
///           ln(1 + m); ln((m+1)/(n-m+1)); ln((m+1)/(m2+1)) with m2 the most matches outside S within 5 pr of one other pose, more
///           than 10 pr from T; -ln(0.01 + u) with u the root mean square displacement of the matched points predicted by
///           s^2 (sum J^T J)^-1, s^2 = sum e^2 / max(1, 3m-6), 100 if singular or m < 4, pr; the share of the groupers whose own pose is
///           within 10 pr of T; overlap; -rms/4 pr; -in_front; -ln(1 + moved_pr).
/// Source    the choice is that of [chen2023sc2pcr]; the signals are ours.
/// Returns   no pose if no grouper has one. Deterministic for any number of threads.
Registration register_pair(const CorrespondenceSet& matches, const std::optional<RegisteredSurfaces>& surfaces,
                           const ParallelFor& parallel = one_by_one, const RegistrationObserver& observer = {});

}  // namespace corral
