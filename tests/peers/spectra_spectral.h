// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/correspondence_set.h"

namespace corral::peers {

/// The spectral technique as one would write it with Spectra: the loop of grouping/spectral.h over a dense binary graph,
/// one eigenvector per accepted match by its Lanczos iteration (20 vectors, 1e-10). Where two parts of the graph are
/// equally heavy, its vector is any mixture of theirs, and the choice may differ from ours.
Indices group_with_spectra(const CorrespondenceSet& matches, double similarity);

}  // namespace corral::peers
