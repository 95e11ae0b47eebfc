// SPDX-License-Identifier: MIT
#include "apps/pair/truth_fit.h"

#include <optional>

#include "apps/runtime/text_table.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr Eigen::Index kMostPoints = 3000;
constexpr double kLeastShare = 0.02;  // below: contacts by chance
constexpr double kMostOfAll = 0.5;    // enough where a turn changes nothing, as on a sphere
constexpr double kBelongs = 1.05;     // distinctness of a truth; wrong ones reach 1.5 now and then
constexpr double kConvinces = 2;      // that of what would be right instead
constexpr double kFactors[] = {0.001, 1000, 0.01, 100, 0.1, 10, 25.4, 1 / 25.4};

/// Evenly over the rows.
Points some_of(const Points& points) {
  const Eigen::Index step = (points.rows() + kMostPoints - 1) / kMostPoints;
  if (step <= 1) return points;
  Points some((points.rows() + step - 1) / step, 3);
  for (Eigen::Index row = 0; row < some.rows(); ++row) some.row(row) = points.row(row * step);
  return some;
}

std::string in_words(const Coincidence& fit) {
  if (!fit.median_pr) return "nothing within 2 pr";
  return fixed(100 * fit.share, fit.share < 0.1 ? 1 : 0) + " % within 2 pr, median " + fixed(*fit.median_pr, 2) + " pr";
}

/// The surfaces under any motion.
class Surfaces {
 public:
  Surfaces(const Points& points, const Points& surface, const PointTree& tree, double resolution)
      : points_(some_of(points)), surface_(surface), tree_(tree), resolution_(resolution) {}

  Coincidence fit(const RigidTransform& motion) const {
    return coincidence(points_, surface_, tree_, motion, resolution_);
  }
  double distinctness_of(const Coincidence& found, const RigidTransform& motion) const {
    return distinctness(found, points_, tree_, motion, resolution_);
  }

  /// What would be right instead of something so distinct; absent if it is not.
  std::optional<Coincidence> convincing(const RigidTransform& motion, const Coincidence& given, double distinct) const {
    const Coincidence found = fit(motion);
    if (!found.is_good() || found.share < 1.5 * given.share) return std::nullopt;
    if (found.share < kMostOfAll && distinctness_of(found, motion) < kConvinces * std::max(1.0, distinct))
      return std::nullopt;
    return found;
  }

 private:
  Points points_;
  const Points& surface_;
  const PointTree& tree_;
  double resolution_;
};

}  // namespace

std::string TruthFit::name() const {
  switch (verdict) {
    case Fits:
      return "fits";
    case Loose:
      return "loose";
    case Inverted:
      return factor == 1 ? "inverted" : "inverted, translation times " + to_text(factor);
    case OtherUnits:
      return "translation times " + to_text(factor);
    case Transposed:
      return "transposed";
    case Misplaced:
      break;
  }
  return "misplaced";
}

std::string TruthFit::text() const {
  const std::string as_given = "as given " + in_words(given);
  switch (verdict) {
    case Fits:
      return "";
    case Loose:
      return "the truth fits loosely: " + in_words(given);
    case Inverted:
      return "the truth fits inverted" +
             (factor == 1 ? "" : ", with its translation multiplied by " + to_text(factor)) + ": " + in_words(mended) +
             "; " + as_given;
    case OtherUnits:
      return "wrong units: the truth fits if its translation is multiplied by " + to_text(factor) + ": " +
             in_words(mended) + "; " + as_given;
    case Transposed:
      return "the truth fits if its rotation is transposed: " + in_words(mended) + "; " + as_given;
    case Misplaced:
      break;
  }
  return "the truth fits neither as given (" + in_words(given) +
         ") nor inverted, transposed or in other units: it is that of another pair, or the surfaces hardly overlap";
}

TruthFit fit_truth(const Points& points, const Points& surface, const PointTree& tree_of_surface,
                   const RigidTransform& truth, double resolution) {
  const Surfaces surfaces(points, surface, tree_of_surface, resolution);
  TruthFit found;
  found.given = surfaces.fit(truth);
  const Coincidence& given = found.given;
  found.verdict = given.is_good() ? TruthFit::Fits : TruthFit::Loose;
  if (given.share >= kMostOfAll && given.is_good()) return found;
  const double distinct = given.share >= kLeastShare ? surfaces.distinctness_of(given, truth) : 0;
  const auto instead = [&](TruthFit::Verdict verdict, double factor, const RigidTransform& motion) {
    const auto mended = surfaces.convincing(motion, given, distinct);
    if (mended) found = {verdict, factor, given, *mended};
    return mended.has_value();
  };
  if (instead(TruthFit::Inverted, 1, truth.inverse())) return found;
  const auto transposed = [](const RigidTransform& motion) {
    return RigidTransform{motion.rotation.transpose(), motion.translation};
  };
  if (instead(TruthFit::Transposed, 1, transposed(truth))) return found;
  if (instead(TruthFit::Transposed, 1, transposed(truth.inverse()).inverse())) return found;  // asked from the target
  if (given.share >= kLeastShare && (distinct >= kBelongs || given.near_share >= kMostOfAll)) return found;
  for (const double factor : kFactors) {
    const RigidTransform scaled{truth.rotation, factor * truth.translation};
    if (instead(TruthFit::OtherUnits, factor, scaled)) return found;
    if (instead(TruthFit::Inverted, factor, scaled.inverse())) return found;
  }
  found.verdict = TruthFit::Misplaced;
  return found;
}

TruthFit fit_truth(const Mesh& source, const Mesh& target, const RigidTransform& target_from_source,
                   const PointSpacing& source_spacing, const PointSpacing& target_spacing) {
  const double from = source_spacing.without_strays, to = target_spacing.without_strays;
  if (from >= to)
    return fit_truth(source.vertices, target.vertices, PointTree(target.vertices), target_from_source, (from + to) / 2);
  return fit_truth(target.vertices, source.vertices, PointTree(source.vertices), target_from_source.inverse(),
                   (from + to) / 2);
}

Json to_json(const TruthFit& fit) {
  Json json = {{"belongs", fit.belongs()},
               {"verdict", fit.name()},
               {"share_within_2pr", fit.given.share},
               {"median_pr", json_or_null(fit.given.median_pr)},
               {"text", fit.text()}};
  if (fit.mended.median_pr)
    json["instead"] = {{"share_within_2pr", fit.mended.share}, {"median_pr", json_or_null(fit.mended.median_pr)}};
  return json;
}

}  // namespace corral
