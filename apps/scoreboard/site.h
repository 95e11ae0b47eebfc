// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/scoreboard/board.h"
#include "io/disk/file.h"

namespace corral {

/// What a reader wants to know of a method beside its scores; texts are empty where it is not known.
struct MethodFacts {
  std::string title, principle, url, licence, needs;
  std::string determinism;                            ///< "same rows for the same table"
  std::optional<double> memory_1k_mb, memory_10k_mb;  ///< peak, for 1,000 and 10,000 matches
  std::vector<std::string> broken;                    ///< checks of the contract that it breaks (conformance.h)
  bool is_checked = false;                            ///< the contract was put to it
};
using FactsByMethod = std::map<std::string, MethodFacts>;

/// A site that opens from disk and that any web server can serve: index.html, a page for each board and a card for each method.
/// Texts of studies are never markup. Files are below `folder`.
std::vector<FileContent> scoreboard_site(const std::vector<Board>& boards, const FactsByMethod& facts,
                                         const std::string& folder);

/// Everything on the site as JSON.
std::string scoreboard_json(const std::vector<Board>& boards, const FactsByMethod& facts);

}  // namespace corral
