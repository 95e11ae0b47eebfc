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
                                                   {"oracle", {"oracle", "#888888", 0, "(2,3)"}},
                                                   {"baseline", {"baseline", "#888888", 0, "(10,5)"}}};

// For groupers that are not in the paper: colours and markers that none of the seven has.
const std::vector<std::string> kFurtherColors = {"#882255", "#999933", "#332288", "#aa4499",
                                                 "#117733", "#661100", "#6699cc", "#aa4466"};
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
