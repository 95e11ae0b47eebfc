// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "apps/claims/averaging.h"
#include "kernel/options.h"

namespace corral {

/// Another form of the pairs of a data set.
enum class PairForm {
  AsStored,
  Swapped,  ///< what was the target is the source, and the truth is inverted
  Cloud,    ///< the target has no faces
};
constexpr std::array<const char*, 3> choice_names(PairForm) { return {"as-stored", "swapped", "cloud"}; }

/// One way to read an open point of the paper, as the options and settings that it stands for.
struct Reading {
  std::string name, text;                       ///< the text is one sentence
  std::string from, evidence;                   ///< where it comes from (kReadingSources), and what is said there
  OptionsByName options;                        ///< of groupers, detectors and descriptors
  std::map<std::string, std::string> matching;  ///< keys of [matching] in an experiment
  PairForm pairs = PairForm::AsStored;
  Averaging averaging;
  int least_true_matches = 1;
  std::vector<std::string> experiments;  ///< those that it touches; empty: all
};

constexpr std::array<const char*, 4> kReadingSources = {"text", "later code", "library", "neither"};

/// A point that the paper leaves open. The first reading is the one that the text asks for, or is nearest to it.
struct OpenPoint {
  std::string name, question;
  std::vector<Reading> readings;
};

/// paper/readings.toml, or a file of the same keys. Throws IoError naming file, line and key.
std::vector<OpenPoint> parse_readings(const std::string& path, const std::string& text);
std::vector<OpenPoint> built_in_readings();

/// A reading for each point, by its place there. All 0: the text.
using Combination = std::vector<int>;

/// The readings of a combination that are not the text's, in order: "normals=origin st=once"; "text" if there are none.
std::string to_text(const std::vector<OpenPoint>& points, const Combination& combination);

/// How many of them there are.
int departures(const Combination& combination);

/// What is set by the readings of a combination, all together.
struct ReadingSettings {
  OptionsByName options;
  std::map<std::string, std::string> matching;
  PairForm pairs = PairForm::AsStored;
  Averaging averaging;
  int least_true_matches = 1;
};
ReadingSettings settings_of(const std::vector<OpenPoint>& points, const Combination& combination);

/// Whether a reading changes the matches of pairs, so that they are matched anew; else what groupers or means do with them.
bool changes_matches(const Reading& reading);

/// The part of a combination that changes the matches of an experiment; all other points read as the text does.
Combination matching_part(const std::vector<OpenPoint>& points, const Combination& combination,
                          const std::string& experiment);

}  // namespace corral
