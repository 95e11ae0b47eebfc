// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "kernel/rigid_transform.h"
#include "kernel/types.h"

namespace corral::peers {

/// Point-to-point iterative closest points of the Point Cloud Library, with its defaults but for what is compared: a number
/// of rounds, all of which are run, and the distance up to which points are paired. The clouds are converted once, in the
/// constructor; the kd-tree is built within the call.
class PclIcp {
 public:
  PclIcp(const Points& source, const Points& target);  ///< coordinates are rounded to float
  ~PclIcp();
  PclIcp(const PclIcp&) = delete;

  struct Result {
    RigidTransform target_from_source;
    int rounds = 0;
  };
  Result align(const RigidTransform& start, double limit, int rounds) const;

 private:
  struct Clouds;
  std::unique_ptr<Clouds> clouds_;
};

}  // namespace corral::peers
