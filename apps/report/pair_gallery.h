// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/results/study_folder.h"
#include "io/disk/file.h"

namespace corral {

/// A pair of a study, which must outlive this, with the record whose selections are drawn.
struct GalleryPair {
  const StudyFolder* run = nullptr;
  const StudyRecord* record = nullptr;  ///< of the first method
  std::string name() const { return record->dataset + "/" + record->pair; }
};

/// The named pairs ("dataset/pair", or "pair" in every data set), or else the pair of each data set with the median share of
/// correct matches. Only pairs with selections are considered. Throws InvalidInput for an unknown name.
std::vector<GalleryPair> choose_gallery(const std::vector<StudyFolder>& runs, const std::vector<std::string>& names);

/// Pictures of a pair, named <dataset>-<pair>-...png: the matches of each grouper, all of them on one sheet (matches.png),
/// and the source aligned with the target by the poses of every grouper before and after refinement (aligned.png). Throws
/// IoError for a missing file, or a match whose vertex does not exist.
std::vector<FileContent> draw_gallery_pair(const GalleryPair& pair);

}  // namespace corral
