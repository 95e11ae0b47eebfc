// SPDX-License-Identifier: MIT
#include "apps/report/figure/legend.h"

#include <algorithm>

#include "apps/report/figure/printed_text.h"

namespace corral {
namespace {

constexpr double kSample = 22;  // the length of a line

}  // namespace

Legend::Legend(const std::vector<std::string>& methods, double width, const MethodTitles& titles) {
  const auto styles = method_styles(methods, titles);
  for (const std::string& method : methods) {
    entries_.push_back(styles.at(method));
    entries_.back().label = shortened(entries_.back().label, kMostOfName);
  }
  for (std::size_t columns = 2; columns <= entries_.size(); ++columns)
    if (width_of(columns) <= width - 2 * kGap) columns_ = columns;
  columns_ = entries_.empty() ? 1 : (entries_.size() + rows() - 1) / rows();  // rows of equal length
}

std::size_t Legend::rows() const { return (entries_.size() + columns_ - 1) / columns_; }
double Legend::height() const { return static_cast<double>(rows()) * kLine; }

double Legend::column_width(std::size_t column, std::size_t columns) const {
  double widest = 0;
  for (std::size_t i = column; i < entries_.size(); i += columns)
    widest = std::max(widest, printed_width(entries_[i].label));
  return kSample + kGap + widest;
}

double Legend::width_of(std::size_t columns) const {
  double width = 2 * kGap * static_cast<double>(columns - 1);
  for (std::size_t column = 0; column < columns; ++column) width += column_width(column, columns);
  return width;
}

void Legend::draw(Drawing& drawing, double top) const {
  double x = (drawing.width() - width_of(columns_)) / 2;
  for (std::size_t column = 0; column < columns_; ++column) {
    for (std::size_t i = column; i < entries_.size(); i += columns_) {
      const double y = top + (static_cast<double>(i / columns_) + 0.5) * kLine;
      drawing.line(x, y, x + kSample, y, pen_of(entries_[i]));
      if (entries_[i].point > 0)
        drawing.marker(x + kSample / 2, y, marker_of(entries_[i]) + " linecolor rgb '" + entries_[i].color + "'");
      drawing.words(x + kSample + kGap, y, entries_[i].label, Align::Left);
    }
    x += column_width(column, columns_) + 2 * kGap;
  }
}

}  // namespace corral
