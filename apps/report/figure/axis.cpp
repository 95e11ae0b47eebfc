// SPDX-License-Identifier: MIT
#include "apps/report/figure/axis.h"

#include <algorithm>
#include <cmath>

#include "apps/report/figure/drawing.h"
#include "apps/report/figure/printed_text.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr double kTicks = 8;  // from the axis to its labels

/// Whether each label is kept: the last, and towards the first every one that has so much room.
std::vector<bool> kept(const std::vector<double>& places, double room) {
  std::vector<bool> keep(places.size(), false);
  std::size_t last = places.size() - 1;
  for (std::size_t i = places.size(); i-- > 0;)
    if (i == last || std::abs(places[last] - places[i]) >= room) {
      keep[i] = true;
      last = i;
    }
  return keep;
}

bool is_number(const std::string& label) { return parse_double(label).has_value(); }

}  // namespace

AxisLabels fit_labels(const std::vector<std::string>& labels, const std::vector<double>& places) {
  if (labels.empty()) return {};
  AxisLabels fitted{labels, false, kTicks + kLine};
  const double widest = widest_of(labels);
  std::vector<bool> keep = kept(places, widest + kGap);
  const bool fit = std::all_of(keep.begin(), keep.end(), [](bool is_kept) { return is_kept; });
  if (!fit && !std::all_of(labels.begin(), labels.end(), is_number)) {
    fitted.are_upright = true;
    for (std::string& text : fitted.texts) text = shortened(text, kMostOfName);
    fitted.depth = kTicks + std::min(kMostOfName, widest) + kGap / 2;
    keep = kept(places, kLine);
  }
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (!keep[i]) fitted.texts[i].clear();
  return fitted;
}

void Decades::add(const std::optional<double>& value) {
  if (!value || !(*value > 0)) return;
  least_ = std::min(least_.value_or(*value), *value);
  largest_ = std::max(largest_.value_or(*value), *value);
}

std::vector<double> Decades::numbers() const {
  const auto first = static_cast<int>(std::floor(std::log10(least_.value_or(1))));
  const auto last = static_cast<int>(std::floor(std::log10(largest_.value_or(1)))) + 1;
  std::vector<double> powers;
  for (int power = first; power <= last; ++power) powers.push_back(*parse_double("1e" + std::to_string(power)));
  return powers;
}

std::vector<std::string> Decades::labels() const {
  std::vector<std::string> texts;
  for (const double number : numbers()) texts.push_back(to_text(number));
  return texts;
}

std::string logarithmic_axis(const std::string& axis, const Decades& decades, const std::vector<std::string>& labels) {
  return "set logscale " + axis + "\nset " + axis + "range [" + to_text(decades.low()) + ":" + to_text(decades.high()) +
         "]\nset " + axis + "tics " + (axis == "x" ? kNearAxis : "") + tics_text(labels, decades.numbers()) + "\n";
}

double width_beside_axis(const std::vector<std::string>& labels) { return kTicks + widest_of(labels); }

}  // namespace corral
