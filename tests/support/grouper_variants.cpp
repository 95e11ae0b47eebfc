// SPDX-License-Identifier: MIT
#include "tests/support/grouper_variants.h"

#include <algorithm>
#include <iterator>

#include "tests/support/reference/clique.h"
#include "tests/support/reference/frame_ransac.h"
#include "tests/support/reference/mac.h"
#include "tests/support/reference/sc2pcr.h"
#include "tests/support/reference/turboreg.h"

namespace corral::testing {
namespace {

/// A grouper and its reference, before the options are known.
template <class Options>
class Method {
 public:
  Method(GroupingResult (*group)(const CorrespondenceSet&, const Options&),
         reference::Selection (*reference)(const CorrespondenceSet&, const Options&))
      : group_(group), reference_(reference) {}

  GrouperVariant operator()(const char* name, const Promises& promises, const OptionOverrides& overrides = {}) const {
    const auto bound = [options = parse_options<Options>(overrides, name)](auto method) {
      return [=](const CorrespondenceSet& matches) { return method(matches, options); };
    };
    return {name, bound(group_), bound(reference_), promises};
  }

 private:
  GroupingResult (*group_)(const CorrespondenceSet&, const Options&);
  reference::Selection (*reference_)(const CorrespondenceSet&, const Options&);
};

Promises promising(Copies copies) {
  Promises promises;
  promises.copies = copies;
  return promises;
}

/// Triples are drawn by the numbers of rows.
Promises of_triples() {
  Promises promises;
  promises.numbers_rows = true;
  return promises;
}

/// The centroid of the source is carried by frames into cells of the target.
Promises of_votes(Turns turns) {
  Promises promises = promising(Copies::Both);
  promises.symmetric = false;
  promises.turns = turns;
  return promises;
}

/// Neighbours are those in the source.
Promises of_voters(bool knows_origin = false) {
  Promises promises;
  promises.symmetric = false;
  promises.knows_origin = knows_origin;
  return promises;
}

/// Source and target are not alike.
Promises of_one_side() {
  Promises promises;
  promises.symmetric = false;
  return promises;
}

std::vector<GrouperVariant> make_variants() {
  const Method ss(group_by_similarity_score, reference::similarity_score);
  const Method nnsr(group_by_nearest_neighbor_ratio, reference::nearest_neighbor_ratio);
  const Method ransac(group_by_ransac, reference::ransac);
  const Method st(group_by_spectral, reference::spectral);
  const Method gc(group_by_geometric_consistency, reference::geometric_consistency);
  const Method hough(group_by_hough_voting, reference::hough_voting);
  const Method si(group_by_search_of_inliers, reference::search_of_inliers);
  const Method turboreg(group_by_turboreg, reference::turboreg);
  const Method sc2pcr(group_by_sc2pcr, reference::sc2pcr);
  const Method frame_ransac(group_by_frame_ransac, reference::frame_ransac);
  const Method clique(group_by_clique, reference::clique);
  const Method mac(group_by_mac, reference::mac);
  const Promises unlike = promising(Copies::Unlike), both = promising(Copies::Both), first = promising(Copies::First);
  return {
      ss("ss", both),
      ss("ss_bins100", both, {{"otsu", "bins100"}}),
      ss("ss_covis", unlike, {{"otsu", "covis"}}),  // as many bins as the number of rows says
      nnsr("nnsr", both),
      nnsr("nnsr_literal", both, {{"ratio", "literal"}, {"threshold", "0.3"}}),
      nnsr("nnsr_literal_any", both, {{"ratio", "literal"}, {"threshold", "0"}}),  // but none without a second feature
      ransac("ransac", of_triples(), {{"iterations", "100"}}),
      ransac("ransac_tight", of_triples(), {{"iterations", "100"}, {"tolerance_pr", "1"}, {"seed", "7"}}),
      st("st", first),
      st("st_once", first, {{"once", "true"}}),
      st("st_weighted", first, {{"weighted", "true"}}),
      st("st_weighted_once", first, {{"weighted", "true"}, {"once", "true"}}),
      st("st_strict", first, {{"similarity", "0.9"}}),
      gc("gc", both),
      gc("gc_clique", unlike, {{"cluster", "clique"}}),  // two copies of two rows are enough for a cluster
      hough("hough", of_votes(Turns::AxesToAxes)),
      hough("hough_coarse", of_votes(Turns::AxesToAxes), {{"bins", "3"}}),
      hough("hough_pr5", of_votes(Turns::AxesInCycle), {{"cells", "pr5"}}),
      si("si", of_voters()),
      si("si_few_voters", of_voters(), {{"voters", "6"}}),
      si("si_covis", of_voters(), {{"form", "covis"}, {"otsu", "covis"}}),
      si("si_covis_few_voters", of_voters(), {{"form", "covis"}, {"voters", "6"}}),
      si("si_rotation", of_voters(true), {{"form", "rotation"}}),
      si("si_bins100", of_voters(), {{"otsu", "bins100"}}),
      turboreg("turboreg", unlike),
      turboreg("turboreg_raw", unlike, {{"refit_rounds", "0"}, {"edge_pr", "0.5"}, {"score", "mse"}}),
      turboreg("turboreg_few_pivots", unlike, {{"pivots", "3"}, {"min_length_pr", "0"}, {"score", "mae"}}),
      turboreg("turboreg_oamae", of_one_side(), {{"score", "oamae"}}),  // for each point of the target
      sc2pcr("sc2pcr", of_one_side()),                                  // seeds are apart in the source
      sc2pcr("sc2pcr_raw", of_one_side(), {{"refit_rounds", "0"}, {"seed_share", "0.5"}, {"score", "mae"}}),
      sc2pcr("sc2pcr_small", of_one_side(), {{"neighbours", "5"}, {"kept", "4"}, {"distance_pr", "2"}}),
      frame_ransac("frame_ransac", unlike),  // three copies of a row agree with each other
      frame_ransac("frame_ransac_textbook", unlike, {{"polish", "0"}}),
      frame_ransac("frame_ransac_few", unlike, {{"polish", "2"}, {"score", "msac"}, {"tolerance_pr", "3"}}),
      clique("clique", unlike),  // two rows that fit are nothing, twice as many are something
      clique("clique_tight", unlike, {{"edge_pr", "1"}, {"refit", "kabsch"}}),
      clique("clique_core", unlike, {{"structure", "core"}}),
      mac("mac", unlike, {{"gate", "0.97"}}),  // no table takes more than max_steps: the reference has no bound
      mac("mac_tight", unlike,
          {{"gate", "0.999"}, {"score", "inliers"}, {"refit_rounds", "0"}, {"cliques_per_node", "2"}}),
  };
}

}  // namespace

const std::vector<GrouperVariant>& grouper_variants() {
  static const std::vector<GrouperVariant> variants = make_variants();
  return variants;
}

std::vector<GrouperVariant> variants_where(const std::function<bool(const Promises&)>& fits) {
  std::vector<GrouperVariant> fitting;
  std::copy_if(grouper_variants().begin(), grouper_variants().end(), std::back_inserter(fitting),
               [&](const GrouperVariant& variant) { return fits(variant.promises); });
  return fitting;
}

}  // namespace corral::testing
