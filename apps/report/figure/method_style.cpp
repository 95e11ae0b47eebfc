// SPDX-License-Identifier: MIT
#include "apps/report/figure/method_style.h"

#include <set>

namespace corral {
namespace {

const std::map<std::string, MethodStyle> kKnown = {{"ss", {"SS", "#000000", 7, "(8,4)"}},
                                                   {"nnsr", {"NNSR", "#e69f00", 5, ""}},
                                                   {"ransac", {"RANSAC", "#0072b2", 9, ""}},
                                                   {"st", {"ST", "#cc79a7", 11, "(14,4)"}},
                                                   {"gc", {"GC", "#009e73", 13, ""}},
                                                   {"hough", {"3DHV", "#56b4e9", 15, "(8,4,2,4)"}},
                                                   {"si", {"SI", "#d55e00", 6, "(4,3)"}},
                                                   {"turboreg", {"TurboReg", "#882255", 4, ""}},
                                                   {"sc2pcr", {"SC2-PCR", "#999933", 8, "(6,3)"}},
                                                   {"clique", {"clique", "#332288", 10, ""}},
                                                   {"mac", {"MAC", "#aa4499", 12, "(6,3)"}},
                                                   {"tcf", {"TCF", "#117733", 14, ""}},
                                                   {"gtm", {"GTM", "#661100", 1, "(6,3)"}},
                                                   {"cv", {"CV", "#6699cc", 2, ""}},
                                                   {"frame-ransac", {"frame RANSAC", "#ddcc77", 3, "(6,3)"}},
                                                   {"auto", {"auto", "#994455", 5, "(10,3)"}},
                                                   {"register", {"register", "#228833", 7, ""}},
                                                   {"oracle", {"oracle", "#888888", 0, "(2,3)"}},
                                                   {"baseline", {"baseline", "#888888", 0, "(10,5)"}}};

// For methods that are not among the groupers: colours that none of those has, and markers that none of the paper has.
const std::vector<std::string> kFurtherColors = {"#44aa99", "#bb5566", "#004488", "#ddaa33",
                                                 "#225522", "#aa7744", "#777711", "#ee8866"};
const std::vector<int> kFurtherPoints = {4, 8, 10, 12, 14, 1, 2, 3};

}  // namespace

std::map<std::string, MethodStyle> method_styles(const std::vector<std::string>& methods, const MethodTitles& titles) {
  std::map<std::string, MethodStyle> styles;
  std::size_t next = 0;
  for (const std::string& method : std::set<std::string>(methods.begin(), methods.end())) {
    const auto known = kKnown.find(method);
    if (known != kKnown.end()) {
      styles[method] = known->second;
      continue;
    }
    const std::size_t choice = next++ % kFurtherColors.size();
    const auto title = titles.find(method);
    styles[method] = {title == titles.end() ? method : title->second, kFurtherColors[choice], kFurtherPoints[choice],
                      choice % 2 == 0 ? "" : "(6,3)"};
  }
  return styles;
}

bool is_bound(const std::string& method) { return method == "oracle" || method == "baseline"; }

}  // namespace corral
