// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "grouping/grouper.h"
#include "kernel/options.h"

namespace corral {

/// How the space of votes is divided.
enum class HoughCells {
  Box,  ///< the bounding box of all votes in `bins` cells per axis, one count per vote
  Pr5,  ///< cubes of 5 pr from the box's lower corner, each vote shared among the 8 nearest by linear interpolation
};
constexpr std::array<const char*, 2> choice_names(HoughCells) { return {"box", "pr5"}; }

struct HoughVotingOptions {
  int bins = 15;
  HoughCells cells = HoughCells::Box;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"bins", "", "", "cells per axis of the box of votes (box only)", within(1, 1000)}, self.bins);
    visit(OptionField{"cells", "", "", "15 bins per axis (box) or interpolated cubes of 5 pr (pr5)"}, self.cells);
  }
};

/// 3D Hough voting (3DHV): the matches whose frames carry the centroid of the source to the same place in the target.
///
///   v_i = L_i (C - p_i)      g_i = L'_i^T v_i + p'_i      selected = { i : g_i in the fullest cell or its 6 face neighbours }
///
/// pr5       selected are the votes with a share in the cell with the largest sum of weights, without its neighbours. The
///           cells extend beyond the corner of the box: a vote near it has a share in the cell below.
/// Source    [tombari2010hough]; form [yang2017evaluation], which prints R twice: the second is its transpose.
/// Reads     source_points, target_points, source_frames, target_frames, resolution, source_centroid (default: the mean
///           of the source points).
/// Returns   selected only.
/// Cost      O(M) time and memory, whatever the extent of the votes. Deterministic.
/// Throws    InvalidInput: option out of range, column absent, ragged or non-finite.
/// Departs   15 bins per axis after the authors' program (the paper gives no size). Ties go to the lowest cell in the order
///           of x, then y, then z. An axis whose extent is mere rounding (at most 1e-6 pr, or 64 ulps of the largest
///           coordinate) has one bin. A match with an invalid frame on either side has no vote and is not selected.
GroupingResult group_by_hough_voting(const CorrespondenceSet& matches, const HoughVotingOptions& options = {});
double working_memory(int matches, const HoughVotingOptions& options);

}  // namespace corral
