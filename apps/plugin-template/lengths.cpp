// SPDX-License-Identifier: MIT
// Keeps the matches whose distances to many other matches are the same on both surfaces.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "grouping/plugin.h"

namespace {
double length(const double* const points[3], int i, int j) {
  return std::hypot(points[0][i] - points[0][j], points[1][i] - points[1][j], points[2][i] - points[2][j]);
}
}  // namespace

int corral_plugin_version() { return CORRAL_PLUGIN_VERSION; }
const char* corral_plugin_name() { return "lengths"; }
const char* corral_plugin_options() { return "tolerance_pr=2 difference of two lengths that agree, pr"; }

const char* corral_plugin_group(const corral_table* table, const char* options, corral_answer* answer) {
  double tolerance = 0;
  if (std::sscanf(options, "tolerance_pr=%lf", &tolerance) != 1 || !(tolerance > 0))
    return "option tolerance_pr: expected a length above 0";
  double most = 0;
  for (int i = 0; i < table->rows; ++i)
    for (int j = 0; j < table->rows; ++j)
      if (i != j && std::abs(length(table->source, i, j) - length(table->target, i, j)) < tolerance * table->resolution)
        most = std::max(most, ++answer->scores[i]);
  for (int i = 0; i < table->rows; ++i) answer->selected[i] = most > 0 && 2 * answer->scores[i] > most;
  answer->has_scores = 1;
  return nullptr;
}
