// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/report/figure/box_panel.h"
#include "apps/report/figure/panel_figure.h"
#include "apps/results/study_results.h"

namespace corral {

/// The figures of some studies.
struct StudyFigures {
  std::vector<PanelFigure> panels;
  std::vector<BoxPanel> boxes;
};

/// For every experiment: a panel over its levels for each measure that is drawn (kFigure) and has any value, with its
/// intervals, precision beside recall and the first pose beside the refined one; the curve of success over thresholds and
/// the distribution of mean errors, refined; and the time, where tables of chosen sizes were timed. Means are those of the
/// summary; no average is taken here. Names are <experiment>-<dataset>-<figure or measure>.
///
/// Throws    IoError: two runs with one experiment on one data set.
StudyFigures study_figures(const std::vector<StudyResults>& studies);

/// Text as a part of a file name: characters other than letters, digits and . _ + become underscores.
std::string file_name_part(const std::string& text);

}  // namespace corral
