// SPDX-License-Identifier: MIT
#pragma once

namespace corral {

/// The folders of a report, and the way to them from its scripts.
constexpr const char *kFigures = "figures/", *kScripts = "scripts/", *kData = "data/", *kTables = "tables/",
                     *kPictures = "pairs/", *kFromScripts = "../";

}  // namespace corral
