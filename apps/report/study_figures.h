// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/report/figure/box_panel.h"
#include "apps/report/figure/panel.h"
#include "apps/results/run_folder.h"

namespace corral {

/// What can be drawn of some runs.
struct StudyFigures {
  std::vector<Panel> panels;
  std::vector<BoxPanel> boxes;
};

/// For every experiment: a panel over its levels for each of precision, recall, F1 and the success of the alignments
/// (initial, refined, dense) that has any value; the curve of success over thresholds and the distribution of mean errors,
/// refined; and the time, where tables of chosen sizes were timed. Means are those of each run's summary.csv, with
/// intervals where it has columns such as precision_low and precision_high; no average is taken here. Names are
/// <experiment>-<dataset>-<measure>.
///
/// Throws    IoError: a summary that is missing or wrong, or two runs with one experiment on one data set.
StudyFigures study_figures(const std::vector<RunFolder>& runs);

/// Text as a part of a file name: what is no letter, digit or one of . _ + becomes an underscore.
std::string file_name_part(const std::string& text);

}  // namespace corral
