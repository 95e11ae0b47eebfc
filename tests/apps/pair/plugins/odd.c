// SPDX-License-Identifier: MIT
// A plug-in that does what its option says, right or wrong; ODD_VERSION and ODD_NAME are given by the build.
#include <math.h>
#include <string.h>

#include "grouping/plugin.h"

int corral_plugin_version(void) { return ODD_VERSION; }
const char* corral_plugin_name(void) { return ODD_NAME; }
const char* corral_plugin_options(void) { return "do=first what to do\n"; }

const char* corral_plugin_group(const corral_table* table, const char* options, corral_answer* answer) {
  if (strstr(options, "do=refuse")) return "not today";
  if (strstr(options, "do=nan")) {
    answer->has_scores = 1;
    if (table->rows > 0) answer->scores[0] = NAN;
  }
  if (strstr(options, "do=shear")) {
    answer->has_pose = 1;
    answer->pose[0] = 2;
  }
  if (strstr(options, "do=pose")) {
    answer->has_pose = 1;
    answer->pose[0] = answer->pose[5] = answer->pose[10] = answer->pose[15] = 1;
    answer->pose[3] = 7;
  }
  if (table->rows > 0) answer->selected[0] = 1;
  return NULL;
}
