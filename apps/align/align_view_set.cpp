// SPDX-License-Identifier: MIT
#include "apps/align/align_view_set.h"

#include <algorithm>
#include <mutex>
#include <tuple>
#include <utility>

#include "apps/pair/confidence_file.h"
#include "apps/pair/match_pair.h"
#include "apps/pair/register_pair.h"

namespace corral {
namespace {

constexpr double kLeastTrust = 0.01;
constexpr int kMostRounds = 10;
constexpr double kStepsOfARound = 0.2;  // cost of aligning a pair from a prediction, relative to matching it

using PossiblePair = std::optional<AlignedPair>;

/// Every pair of views, by number.
std::vector<std::pair<int, int>> all_pairs(int views) {
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < views; ++a)
    for (int b = a + 1; b < views; ++b) pairs.emplace_back(a, b);
  return pairs;
}

class SetAlignment {
 public:
  SetAlignment(const ViewSet& views, const AlignOptions& options, const ParallelFor& parallel,
               const AlignObserver& observer)
      : views_(views), options_(options), parallel_(parallel), observer_(observer) {
    for (int i = 0; i < views.size(); ++i) shapes_.push_back(view_of(views.mesh(i).vertices));
  }

  void match_all() {
    std::vector<SurfaceFeatures> features(static_cast<std::size_t>(views_.size()));
    MatchSettings settings;
    settings.threads = 1;
    parallel_(views_.size(), [&](int i) {
      MatchSettings own = settings;
      own.normals = NormalSide::Mesh;
      const Eigen::Vector3d sensor = views_.sensor(i);
      own.sensor.assign(sensor.data(), sensor.data() + 3);
      features[static_cast<std::size_t>(i)] = describe_surface(views_.mesh(i), views_.resolution(), own);
    });
    measure(all_pairs(views_.size()), "matching", 1, [&](int a, int b) {
      const CorrespondenceSet matches = match_surfaces(
          {views_.mesh(a), features[static_cast<std::size_t>(a)].descriptors},
          {views_.mesh(b), features[static_cast<std::size_t>(b)].descriptors}, views_.resolution(), settings);
      const Registration found =
          register_pair(matches, RegisteredSurfaces{views_.mesh(a), views_.mesh(b), views_.side(a), views_.side(b)});
      if (found.poses.empty()) return PossiblePair();
      const double confidence = built_in_confidence().surfaces.probability(*found.signals);
      if (confidence < kDoubted) return PossiblePair();
      PossiblePair pair = best_of(a, b, {found.poses.front().target_from_source});
      if (pair) pair->confidence = confidence;
      return pair;
    });
  }

  void add(const ViewPair& pose) {
    AlignedPair pair{pose, views_.agreement(pose.a, pose.b, pose.b_from_a), false, {}, {}};
    pair.pose.weight *= trust(pair.agreement);
    result_.pairs.push_back(std::move(pair));
  }

  /// Aligns pairs that do not agree, starting from the poses of the graph. False if that adds no pair.
  bool predict() {
    std::vector<std::pair<int, int>> open;
    for (const auto& [a, b] : all_pairs(views_.size()))
      if (part(a) == part(b) && !has_agreeing(a, b)) open.emplace_back(a, b);
    const std::size_t before = result_.pairs.size();
    measure(open, "aligning again", kStepsOfARound, [&](int a, int b) -> PossiblePair {
      PossiblePair pair = best_of(a, b, {result_.between(a, b)});
      if (!pair || is_known(*pair)) return std::nullopt;
      pair->predicted = true;
      return pair;
    });
    return result_.pairs.size() > before;
  }

  void solve() {
    std::stable_sort(result_.pairs.begin(), result_.pairs.end(), [](const AlignedPair& one, const AlignedPair& other) {
      return std::tie(one.pose.a, one.pose.b) < std::tie(other.pose.a, other.pose.b);
    });
    std::vector<ViewPair> poses;
    for (const AlignedPair& pair : result_.pairs) poses.push_back(pair.pose);
    MultiviewAlignment graph = align_views(shapes_, poses, views_.resolution(), options_.graph);
    result_.world_from_view = std::move(graph.world_from_view);
    result_.part = std::move(graph.part);
    result_.converged = graph.converged;
    for (std::size_t i = 0; i < poses.size(); ++i) result_.pairs[i].judgement = graph.pairs[i];
  }

  AlignedViews result() && { return std::move(result_); }

 private:
  int part(int view) const { return result_.part[static_cast<std::size_t>(view)]; }

  template <class Measure>
  void measure(const std::vector<std::pair<int, int>>& pairs, const std::string& what, double steps,
               const Measure& one) {
    std::vector<PossiblePair> found(pairs.size());
    std::mutex talking;
    parallel_(static_cast<int>(pairs.size()), [&](int i) {
      const auto& [a, b] = pairs[static_cast<std::size_t>(i)];
      if (observer_) {
        const std::lock_guard<std::mutex> lock(talking);
        observer_(what + " " + std::to_string(a + 1) + " and " + std::to_string(b + 1), steps);
      }
      found[static_cast<std::size_t>(i)] = one(a, b);
    });
    for (PossiblePair& pair : found)
      if (pair) result_.pairs.push_back(std::move(*pair));
  }

  /// The start that aligns the two views best, if any does.
  PossiblePair best_of(int a, int b, const std::vector<RigidTransform>& starts) const {
    PossiblePair best;
    for (const RigidTransform& start : starts) {
      const std::optional<RigidTransform> pose = views_.lay(a, b, start);
      if (!pose || views_.share_in_front(a, b, *pose) > options_.most_in_front) continue;
      const ViewAgreement agreement = views_.agreement(a, b, *pose);
      if (agreement.overlap >= options_.least_overlap && (!best || agreement.overlap > best->agreement.overlap))
        best = AlignedPair{{a, b, *pose, trust(agreement)}, agreement, false, {}, {}};
    }
    return best;
  }

  bool has_agreeing(int a, int b) const {
    return std::any_of(result_.pairs.begin(), result_.pairs.end(), [&](const AlignedPair& pair) {
      return pair.pose.a == a && pair.pose.b == b && pair.judgement.verdict != PairVerdict::Contradicts;
    });
  }

  /// The weight of a pair in the graph: small if the surfaces contradict it; given poses are never dropped.
  double trust(const ViewAgreement& agreement) const {
    const bool is_contradicted = agreement.in_front > options_.most_in_front;
    return std::max(agreement.overlap, kLeastTrust) * (is_contradicted ? kLeastTrust : 1);
  }

  /// Whether the pair is listed already, up to half a pr.
  bool is_known(const AlignedPair& pair) const {
    const Points& points = views_.mesh(pair.pose.a).vertices;
    return std::any_of(result_.pairs.begin(), result_.pairs.end(), [&](const AlignedPair& other) {
      if (other.pose.a != pair.pose.a || other.pose.b != pair.pose.b) return false;
      const Points difference = pair.pose.b_from_a.apply(points) - other.pose.b_from_a.apply(points);
      return difference.rowwise().norm().mean() < 0.5 * views_.resolution();
    });
  }

  const ViewSet& views_;
  const AlignOptions& options_;
  const ParallelFor& parallel_;
  const AlignObserver& observer_;
  std::vector<View> shapes_;
  AlignedViews result_;
};

}  // namespace

RigidTransform AlignedViews::between(int a, int b) const {
  return world_from_view[static_cast<std::size_t>(b)].inverse() * world_from_view[static_cast<std::size_t>(a)];
}

double align_steps(int views) { return (1 + kStepsOfARound) * views * (views - 1) / 2; }

AlignedViews align_view_set(const ViewSet& views, const AlignOptions& options, const ParallelFor& parallel,
                            const AlignObserver& observer) {
  SetAlignment alignment(views, options, parallel, observer);
  alignment.match_all();
  alignment.solve();
  for (int round = 0; round < kMostRounds && alignment.predict(); ++round) alignment.solve();
  return std::move(alignment).result();
}

AlignedViews align_view_set(const ViewSet& views, const std::vector<ViewPair>& poses, const AlignOptions& options) {
  SetAlignment alignment(views, options, one_by_one, {});
  for (const ViewPair& pose : poses) alignment.add(pose);
  alignment.solve();
  return std::move(alignment).result();
}

}  // namespace corral
