// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace corral {

/// The labels below an axis: empty where one is left out.
struct AxisLabels {
  std::vector<std::string> texts;
  bool are_upright = false;
  double depth = 0;  ///< of the strip that they take below the axis, with its ticks
};

/// Labels that do not touch each other at places along an axis: level where they fit, numbers thinned, words upright, and
/// these thinned in turn. The last always stays.
AxisLabels fit_labels(const std::vector<std::string>& labels, const std::vector<double>& places);

/// Powers of ten from one below every value above 0, or at it, to one above; 1 and 10 if there is none.
class Decades {
 public:
  void add(const std::optional<double>& value);
  double low() const { return numbers().front(); }
  double high() const { return numbers().back(); }
  std::vector<double> numbers() const;      ///< the powers
  std::vector<std::string> labels() const;  ///< theirs

 private:
  std::optional<double> least_, largest_;
};

/// For `set xtics`: gnuplot leaves a line between an axis and its labels, on a screen more than on paper.
constexpr const char* kNearAxis = "offset 0,0.3 ";

/// The commands for a logarithmic axis, "x" or "y", with labels at the powers or others of their number.
std::string logarithmic_axis(const std::string& axis, const Decades& decades, const std::vector<std::string>& labels);

/// The room that the labels of a vertical axis take beside it, with its ticks.
double width_beside_axis(const std::vector<std::string>& labels);

}  // namespace corral
