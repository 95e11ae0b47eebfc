// SPDX-License-Identifier: MIT
#include "tests/benchmarks/grouper_peers.h"

#include <limits>
#include <memory>

#include "tests/benchmarks/natural_tables.h"
#include "tests/benchmarks/plain_groupers.h"
#include "tests/support/reference/groupers.h"
#ifdef CORRAL_WITH_PCL
#include "tests/peers/pcl_grouping.h"
#endif
#ifdef CORRAL_WITH_SPECTRA
#include "tests/peers/spectra_spectral.h"
#endif

namespace corral::benchmarks {
namespace {

using benchmark::DoNotOptimize;
using Prepare = std::function<Call(const CorrespondenceSet&)>;
constexpr int kAny = std::numeric_limits<int>::max();

/// A peer that reads our table as it is.
template <class Group>
Prepare on_table(Group group) {
  return [group](const CorrespondenceSet& matches) -> Call {
    return [group, &matches] { DoNotOptimize(group(matches)); };
  };
}

std::vector<GrouperPeer> plain_peers() {
  return {
      {"ss", "std-sort", kAny,
       [](const CorrespondenceSet& matches) -> Call {
         return in_turn(matches, [](const CorrespondenceSet& table) { DoNotOptimize(plain::sorted_scores(table)); });
       }},
      {"nnsr", "one-pass", kAny, on_table(plain::ratio_scores)},
      {"gc", "loops", kAny,
       on_table([](const CorrespondenceSet& matches) { return plain::largest_star(matches, 3 * matches.resolution); })},
      {"si", "loops", 2000,
       on_table([](const CorrespondenceSet& matches) { return reference::search_of_inliers(matches, {}).rows; })},
  };
}

#ifdef CORRAL_WITH_SPECTRA
std::vector<GrouperPeer> spectra_peers() {
  return {{"st", "spectra", 2000,
           on_table([](const CorrespondenceSet& matches) { return peers::group_with_spectra(matches, 0.6); })}};
}
#else
std::vector<GrouperPeer> spectra_peers() { return {}; }
#endif

#ifdef CORRAL_WITH_PCL
/// A peer that reads PCL's clouds; it is also told how long 1 pr is.
Prepare on_clouds(Indices (*group)(const peers::PclGrouping&, double)) {
  return [group](const CorrespondenceSet& matches) -> Call {
    const auto clouds = std::make_shared<peers::PclGrouping>(matches);
    return [group, clouds, pr = matches.resolution] { DoNotOptimize(group(*clouds, pr)); };
  };
}

std::vector<GrouperPeer> pcl_peers() {
  using Pcl = peers::PclGrouping;
  return {
      {"ransac", "pcl", kAny, on_clouds([](const Pcl& pcl, double pr) { return pcl.ransac(5 * pr, 10000); })},
      {"gc", "pcl", kAny, on_clouds([](const Pcl& pcl, double pr) { return pcl.geometric_consistency(3 * pr); })},
      {"hough", "pcl", kAny, on_clouds([](const Pcl& pcl, double pr) { return pcl.hough_voting(5 * pr); })},
  };
}
#else
std::vector<GrouperPeer> pcl_peers() { return {}; }
#endif

}  // namespace

const std::vector<GrouperPeer>& grouper_peers() {
  static const std::vector<GrouperPeer> all = [] {
    std::vector<GrouperPeer> peers = pcl_peers();
    for (const auto& more : {spectra_peers(), plain_peers()}) peers.insert(peers.end(), more.begin(), more.end());
    return peers;
  }();
  return all;
}

}  // namespace corral::benchmarks
