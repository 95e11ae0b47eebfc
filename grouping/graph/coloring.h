// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/graph/missing_edges.h"

namespace corral {

/// Colours some nodes of a graph, one after the other: each gets the first colour that none of its neighbours has.
class Coloring {
 public:
  /// Both must outlive it.
  Coloring(const BitGraph& graph, const MissingEdges& missing);

  /// The nodes of a colour of `least` or above by their colours, and these. Returns the number of colours.
  int operator()(const std::vector<BitGraph::Word>& nodes, int least, Indices& order, Indices& colors);

  /// Words read so far, a node of a list counted as eight: a measure of its work.
  std::int64_t work() const { return work_; }

 private:
  static constexpr std::int64_t kWorkPerNode = 8;

  int color_word(std::size_t word);
  void color_by_words(std::size_t first);
  void color_by_lists(int node);

  const BitGraph& graph_;
  const MissingEdges& missing_;
  std::vector<BitGraph::Word> left_, apart_;  ///< nodes without a colour; and no neighbours of those of the present one
  Indices alike_;                             ///< nodes of the present colour
  std::int64_t work_ = 0;
};

}  // namespace corral
