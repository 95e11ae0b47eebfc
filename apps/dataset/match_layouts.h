// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernel/rigid_transform.h"

namespace corral {

/// The files of one pair of a published folder. Empty: it has none.
struct PairFiles {
  std::string name;                              ///< of the pair, such as "scene-cloud_bin_0+cloud_bin_4"
  std::string matches, targets;                  ///< as in ForeignFiles
  std::string source_features, target_features;  ///< as in FeatureFiles, matched where there are no matches
  std::string source, target;                    ///< clouds
  std::string truth;                             ///< a pose as read_transform names it, source to target
  std::string rotation, translation;             ///< the same in two files
  std::optional<RigidTransform> pose = {};       ///< the same, of a list of pairs
  std::string labels;
  std::vector<std::pair<std::string, std::string>> attributes = {};  ///< columns of pairs.csv with their cells
};

/// The layouts that are known, by the programs and data sets that use them.
const std::vector<std::string>& match_layouts();

/// What the folder and its subfolders hold, in the order of the names.
///
///   mac      corr.txt, corr_data.txt or A+B@corr[_DESCRIPTOR].txt, with label, GTmat and the clouds A and B
///   points   ID_kpts_src.txt, ID_kpts_dst.txt, ID_trans.txt, ID_pts_src.ply (TurboReg); v1.csv, v2.csv, R_gt.csv, t_gt.csv and
///            other files of source and target points (TEASER++)
///   npz      a file of arrays for each pair (SC2-PCR, PointDSC, GeoTransformer)
///   tcf      A_B_top3.match, A-B.pose, clouds A*.pcd, B*.pcd
///   3dmatch  gt.log of a scene, with its cloud_bin_N.ply or features cloud_bin_N_fcgf.npz; gt.info
///   kitti    SEQUENCE_SOURCE_TARGET.npy or .txt: a pose, frame to frame; or a list of pairs as read_scan_list knows it;
///            with SEQUENCE/velodyne/SOURCE.bin
///   corral   NAME.matches.csv, NAME.xf
///
/// `layout` empty: the one that is there. Throws IoError if there is none, or several.
std::vector<PairFiles> find_match_pairs(const std::string& folder, const std::string& layout);

}  // namespace corral
