// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/results/run_folder.h"
#include "io/file.h"

namespace corral {

/// A pair of a run, which must outlive this, with the record whose selections are to be looked at.
struct GalleryPair {
  const RunFolder* run = nullptr;
  const StudyRecord* record = nullptr;  ///< of the first method
  std::string name() const { return record->dataset + "/" + record->pair; }
};

/// The named pairs ("dataset/pair", or "pair" in every data set), or else of each data set the one in the middle when
/// pairs are put in order of their share of right matches. Only pairs with selections are seen. Throws InvalidInput for
/// a name that no run has.
std::vector<GalleryPair> choose_gallery(const std::vector<RunFolder>& runs, const std::vector<std::string>& names);

/// Pictures of a pair, named <dataset>-<pair>-...png: the matches of each method, all of them on one sheet
/// (matches.png), and the source laid on the target by the poses of every method before and after refinement
/// (aligned.png). Throws IoError for a file that is missing, or a match whose vertex a mesh does not have.
std::vector<FileContent> draw_gallery_pair(const GalleryPair& pair);

}  // namespace corral
