// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/results/measures.h"

namespace corral {

/// The number that a rule looks at: a measure, or what else is known of the pairs.
struct Quantity {
  enum class Kind { Measure, Value, Agreement, KeypointDensity };
  Kind kind = Kind::Measure;
  const Measure* measure = &corral::measure("f1");  ///< of Kind::Measure

  bool is_measure(const std::string& name) const { return kind == Kind::Measure && measure->name == name; }
  bool is_time() const { return kind == Kind::Measure && measure->unit == "ms"; }
  bool is_of_pairs() const { return kind != Kind::Measure || measure->has(kOfPair); }  ///< whatever the method
};

/// How the levels (or the pairs) become one number for each method (or one alone), but for EachLevel; see claims.toml.
enum class Take {
  EachLevel,
  Mean,
  Range,
  Rise,
  RelativeDrop,
  LargestRise,
  LargestFall,
  LeastStep,
  Spearman,
  Slope,
  Correlation,
  Wins,
  MeanRank,
  Percentile,
  Count
};

/// At how many of the levels a rule has to hold.
enum class Quantifier { Every, Most, Half, One };

/// One side of a comparison.
struct Operand {
  enum class Kind { Constant, Methods, All, Largest, Median, Others, Alone, Rank };
  Kind kind = Kind::Constant;
  std::vector<int> methods;  ///< of Methods (their mean) and Rank, as places among ClaimBook::methods
};

/// left > factor * right + offset, such as "nnsr >= ss - tau" or "rank(si) <= 3".
struct Comparison {
  Operand left, right;
  double factor = 1, offset = 0;
  bool is_greater = true, or_equal = false;
};

/// A rule, and the levels that it looks at.
struct ClaimPart {
  std::vector<std::string> experiments;
  std::vector<std::string> with;  ///< others beside them
  Quantity of;
  Take take = Take::EachLevel;
  bool over_pairs = false;  ///< over single pairs instead of the means of levels
  Quantifier where = Quantifier::Every;
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
  std::optional<std::pair<double, double>> first,
      last;                                  ///< of Rise and RelativeDrop between levels; else the first and last
  bool lead = false;                         ///< of each method above the best other, instead of the value
  double inlier_from = 0, inlier_below = 2;  ///< over pairs: only those with such an inlier ratio
  double percent = 50;                       ///< of Percentile
  std::vector<Comparison> is;                ///< all of them
  std::vector<int> largest, smallest;        ///< the methods with the largest or smallest numbers
  int after = 0;                             ///< of largest: so many others come before
  bool ties = false;                         ///< a tie within tau counts for either
  bool is_note = false;                      ///< told, but no part of the verdict
};

/// A statement of the paper and the rule that decides it.
struct Claim {
  std::string id, text, note;
  std::vector<ClaimPart> parts;  ///< holds if all hold
};

/// paper/claims.toml, or a file of the same keys.
struct ClaimBook {
  std::vector<std::string> methods;  ///< those that "all", ranks and medians run over
  double tau = 0.01, time_tau = 0.05;
  int least_pairs = 5;
  std::vector<Claim> claims;
  std::vector<std::string> slips;  ///< contradictions of the paper that are reported, not repaired
};

/// Throws IoError naming file, line and key, with a suggestion for an unknown key or word.
ClaimBook read_claims(const std::string& path);
/// The same of text that is in memory; `path` is for the messages.
ClaimBook parse_claims(const std::string& path, const std::string& text);
ClaimBook built_in_claims();

}  // namespace corral
