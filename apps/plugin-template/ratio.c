// SPDX-License-Identifier: MIT
// Keeps the matches whose feature is much nearer than the second nearest.
#include <stdio.h>

#include "grouping/plugin.h"

int corral_plugin_version(void) { return CORRAL_PLUGIN_VERSION; }
const char* corral_plugin_name(void) { return "ratio"; }
const char* corral_plugin_options(void) { return "most=0.8 largest ratio of the two distances"; }

const char* corral_plugin_group(const corral_table* table, const char* options, corral_answer* answer) {
  double most = 0;
  if (sscanf(options, "most=%lf", &most) != 1) return "option most: expected a number";
  if (!table->feature_distance || !table->second_feature_distance) return "it needs the feature distances";
  for (int i = 0; i < table->rows; ++i)
    answer->selected[i] = table->feature_distance[i] <= most * table->second_feature_distance[i];
  return NULL;
}
