// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/report/figure/drawing.h"

namespace corral {

/// The names of groupers beside their lines and markers, in as few rows as the width allows.
class Legend {
 public:
  Legend(const std::vector<std::string>& methods, double width, const MethodTitles& titles = {});
  double height() const;
  void draw(Drawing& drawing, double top) const;  ///< centred

 private:
  std::size_t rows() const;
  double column_width(std::size_t column, std::size_t columns) const;
  double width_of(std::size_t columns) const;

  std::vector<MethodStyle> entries_;
  std::size_t columns_ = 1;
};

}  // namespace corral
