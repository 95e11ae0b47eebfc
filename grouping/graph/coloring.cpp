// SPDX-License-Identifier: MIT
#include "grouping/graph/coloring.h"

#include <hwy/base.h>

#include <algorithm>

namespace corral {
namespace {

using Word = BitGraph::Word;

int lowest(Word word) { return static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(word)); }

}  // namespace

Coloring::Coloring(const BitGraph& graph, const MissingEdges& missing) : graph_(graph), missing_(missing) {}

int Coloring::operator()(const std::vector<Word>& nodes, int least, Indices& order, Indices& colors) {
  order.clear(), colors.clear();
  left_ = nodes;
  int color = 1;
  for (std::size_t word = 0; word < left_.size();) {
    if (left_[word] == 0) {
      ++word;
    } else if (missing_.are_listed() && color + static_cast<int>(hwy::PopCount(left_[word])) <= least) {
      color += color_word(word);  // of no colour that is asked for
    } else {
      alike_.clear();
      if (missing_.are_listed())
        color_by_lists(64 * static_cast<int>(word) + lowest(left_[word]));
      else
        color_by_words(word);
      if (color >= least) {
        order.insert(order.end(), alike_.begin(), alike_.end());
        colors.resize(order.size(), color);
      }
      ++color;
    }
  }
  return color - 1;
}

/// The number of colours that begin in a word: a node that is connected to all others has one of its own.
int Coloring::color_word(std::size_t word) {
  const Word apart = missing_.with_some()[word];
  int colors = static_cast<int>(hwy::PopCount(left_[word] & ~apart));
  left_[word] &= apart;
  ++work_;
  for (; left_[word] != 0; ++colors) {
    alike_.clear();
    color_by_lists(64 * static_cast<int>(word) + lowest(left_[word]));
  }
  return colors;
}

void Coloring::color_by_words(std::size_t first) {
  apart_ = left_;
  for (std::size_t word = first; word < apart_.size(); ++word)
    while (apart_[word] != 0) {
      const int bit = lowest(apart_[word]), node = 64 * static_cast<int>(word) + bit;
      left_[word] &= ~(Word{1} << bit);
      apart_[word] &= ~(Word{1} << bit);
      const Word* neighbors = graph_.neighbors(node);
      for (std::size_t k = word; k < apart_.size(); ++k) apart_[k] &= ~neighbors[k];
      alike_.push_back(node);
      work_ += static_cast<std::int64_t>(apart_.size() - word);
    }
}

/// A node and of those behind it that it is not connected to each that is no neighbour of one before.
void Coloring::color_by_lists(int node) {
  const auto take = [&](int taken) {
    left_[static_cast<std::size_t>(taken >> 6)] &= ~(Word{1} << (taken & 63));
    alike_.push_back(taken);
  };
  take(node);
  work_ += kWorkPerNode;
  for (const int* other = std::upper_bound(missing_.begin(node), missing_.end(node), node); other != missing_.end(node);
       ++other) {
    work_ += kWorkPerNode;
    const bool is_left = left_[static_cast<std::size_t>(*other >> 6)] >> (*other & 63) & 1;
    if (is_left &&
        std::none_of(alike_.begin() + 1, alike_.end(), [&](int taken) { return graph_.is_edge(taken, *other); }))
      take(*other);
  }
}

}  // namespace corral
