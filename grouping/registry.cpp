// SPDX-License-Identifier: MIT
#include "grouping/registry.h"

#include "grouping/clique.h"
#include "grouping/consistency_voting.h"
#include "grouping/frame_ransac.h"
#include "grouping/game_theory.h"
#include "grouping/geometric_consistency.h"
#include "grouping/hough_voting.h"
#include "grouping/mac.h"
#include "grouping/nearest_neighbor_ratio.h"
#include "grouping/ransac.h"
#include "grouping/sc2pcr.h"
#include "grouping/search_of_inliers.h"
#include "grouping/similarity_score.h"
#include "grouping/spectral.h"
#include "grouping/tcf.h"
#include "grouping/turboreg.h"

namespace corral {
namespace {

template <class Options>
Grouper entry(const char* name, const char* title, const char* principle, const char* citation,
              GroupingResult (*method)(const CorrespondenceSet&, const Options&)) {
  const auto configure = [who = std::string(name), method](const OptionOverrides& overrides) {
    const Options options = parse_options<Options>(overrides, who);
    const auto group = [method, options](const CorrespondenceSet& matches) { return method(matches, options); };
    const auto memory = [options](int matches) { return working_memory(matches, options); };
    return ConfiguredGrouper{group, describe_options(options), memory};
  };
  return {name, title, principle, citation, describe_options(Options{}), configure};
}

}  // namespace

const std::vector<Grouper>& groupers() {
  static const std::vector<Grouper> table = {
      entry("ss", "Similarity score (SS)", "features alike, Otsu's threshold", "yang2017evaluation",
            group_by_similarity_score),
      entry("nnsr", "Nearest-neighbour similarity ratio (NNSR)", "best feature much better than the second",
            "lowe2004distinctive", group_by_nearest_neighbor_ratio),
      entry("ransac", "Random sample consensus (RANSAC)", "agreement with the best pose of random triples",
            "fischler1981random", group_by_ransac),
      entry("st", "Spectral technique (ST)", "principal eigenvector of the compatibility graph",
            "leordeanu2005spectral", group_by_spectral),
      entry("gc", "Geometric consistency (GC)", "largest set that keeps its distances to one seed",
            "chen2007consistency", group_by_geometric_consistency),
      entry("hough", "3D Hough voting (3DHV)", "frames carry the centroid to the same place", "tombari2010hough",
            group_by_hough_voting),
      entry("si", "Search of inliers (SI)", "votes of near and of distinctive matches", "buch2014search",
            group_by_search_of_inliers),
      entry("turboreg", "TurboReg", "best pose of triangles on edges with many common neighbours", "yan2025turboreg",
            group_by_turboreg),
      entry("sc2pcr", "Second-order spatial compatibility (SC2-PCR)",
            "best pose of seeds and those that agree with the same matches", "chen2022sc2pcr", group_by_sc2pcr),
      entry("clique", "Maximum clique (clique)", "largest set that keeps all its distances, robust pose of it",
            "yang2021teaser", group_by_clique),
      entry("mac", "Maximal cliques (MAC)", "best pose of the heaviest maximal clique through each match",
            "zhang2023mac", group_by_mac),
      entry("tcf", "Two-stage consensus filtering (TCF)", "consensus on one match, two, three, then a robust fit",
            "shi2024tcf", group_by_tcf),
      entry("gtm", "Game theory matching (GTM)", "what prevails when matches play for rigid partners",
            "rodola2013scale", group_by_game_theory),
      entry("cv", "Consistency voting (CV)", "lengths and frames agree with a few distinctive matches",
            "yang2021performance", group_by_consistency_voting),
      entry("frame-ransac", "One-point RANSAC with frames", "best pose that one match proposes by its frames",
            "guo2013rotational", group_by_frame_ransac),
  };
  return table;
}

std::vector<std::string> expand_groupers(const std::vector<std::string>& names) {
  constexpr std::size_t kOfThePaper = 7;
  std::vector<std::string> expanded;
  for (const std::string& name : names) {
    const std::size_t count = name == "paper" ? kOfThePaper : name == "all" ? groupers().size() : 0;
    for (std::size_t i = 0; i < count; ++i) expanded.push_back(groupers()[i].name);
    if (count == 0) expanded.push_back(name);
  }
  return expanded;
}

const Grouper& find_grouper(const std::string& name) { return find_entry(groupers(), "grouper", name); }

}  // namespace corral
