// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>

#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {

/// Refuses a radius that holds so many vertices that it cannot be meant. Threads add the neighbours that they find.
class CrowdLimit {
 public:
  struct Subject {
    const char* who;
    const char* field;
    double radius;      ///< mesh units
    std::int64_t mean;  ///< neighbours of a vertex on average, at most
    int usual;
  };

  CrowdLimit(const Subject& subject, std::int64_t vertices)
      : subject_(subject), most_(std::max(kAlwaysAccepted, subject.mean * vertices)) {}

  /// Whether so many of one thread are too many for all.
  bool is_exceeded_by(std::int64_t neighbors) const { return neighbors > most_; }

  /// Throws InvalidInput if these and all before are too many.
  void add(std::int64_t neighbors) {
    if ((neighbors_ += neighbors) > most_)
      throw InvalidInput(subject_.who, subject_.field,
                         to_text(subject_.radius) + " mesh units, which holds over " + std::to_string(subject_.mean) +
                             " vertices on average",
                         "a radius that holds about " + std::to_string(subject_.usual) +
                             " (is the resolution in the unit of this mesh, or do many vertices share one place?)");
  }

 private:
  static constexpr std::int64_t kAlwaysAccepted = 20000000;  // neighbours in all
  Subject subject_;
  std::int64_t most_;
  std::atomic<std::int64_t> neighbors_{0};
};

}  // namespace corral
