// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/report/figure/method_style.h"

namespace corral {

/// What a critical-difference diagram shows.
struct RankDiagram {
  std::string name;  ///< of its files, as of a Panel
  std::string title;
  std::vector<std::string> methods;       ///< 2 or more
  std::vector<double> average_ranks;      ///< one each; 1 is best
  double critical_difference = 0;         ///< average ranks further apart than this differ
  std::vector<std::vector<int>> cliques;  ///< groupers that do not differ significantly, as positions in `methods`
  MethodTitles titles = {};
};

/// method,average_rank in the order of ranks, below a comment line with the critical difference.
std::string rank_csv(const RankDiagram& diagram);

/// A script for gnuplot that needs no data, in the width of a column or, for many or long names, of a page: the best on the
/// left, a bar over every clique. Throws InvalidInput for fewer than 2 methods, or ranks or cliques that do not fit them.
std::string rank_script(const RankDiagram& diagram);

}  // namespace corral
