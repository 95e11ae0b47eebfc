// SPDX-License-Identifier: MIT
#pragma once

// A grouper in a shared library, for `corral --plugin`: plain C, so that any compiler and any language can build one.
//
// A plug-in defines, and exports, the four functions at the end of this file. Several tables may be at work in several threads: it
// must keep nothing between calls. No exception may leave it.

/// Of this file: a plug-in that was built with another one is refused.
#define CORRAL_PLUGIN_VERSION 1

#ifdef __cplusplus
extern "C" {
#endif

/// A table of matches, in columns; row i of each belongs to match i. Valid during the call.
typedef struct corral_table {
  int rows;
  const double* source[3];                ///< x, y, z of the source points, mesh units
  const double* target[3];                ///< x, y, z of the target points, mesh units
  double resolution;                      ///< mesh units per pr
  const double* feature_distance;         ///< to the nearest target feature; null: absent
  const double* second_feature_distance;  ///< to the second nearest, 0: there is none; null: absent
  const double* source_frames;  ///< 9 each, row by row, whose rows are the unit axes; zeros: no frame; null: absent
  const double* target_frames;  ///< the same of the target points
  double source_centroid[3];    ///< mean of all source vertices, mesh units
} corral_table;

/// The answer. Its memory belongs to Corral; everything is zero before the call.
typedef struct corral_answer {
  unsigned char* selected;  ///< one for each row: not zero if the match is kept
  double* scores;           ///< one for each row, larger is better; they count if has_scores is not zero
  int has_scores;
  double pose[16];  ///< 4 x 4, row by row, target from source, mesh units; it counts if has_pose is not zero
  int has_pose;
} corral_answer;

/// CORRAL_PLUGIN_VERSION.
int corral_plugin_version(void);

/// The name of the grouper on the command line: letters, digits and . _ + -, none that Corral has.
const char* corral_plugin_name(void);

/// Its options, one in a line: "tolerance_pr=3 residual up to which a match is kept". Empty if it has none.
const char* corral_plugin_options(void);

/// Groups a table, whose values are all finite. `options`: every option, one in a line, "tolerance_pr=3". Returns null, or a
/// sentence that says why there is no answer; it must stay valid until the next call from the same thread.
const char* corral_plugin_group(const corral_table* table, const char* options, corral_answer* answer);

#ifdef __cplusplus
}
#endif
