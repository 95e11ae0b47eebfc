// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace corral {

/// What a gzip file holds, all its members one after another. Memory grows with what comes out, never by what the file
/// promises; a file of which more comes out than 64 MiB and 100 times its own size is no mesh, and refused.
/// Throws    IoError that names the file and the byte: not gzip, cut short, damaged, too large.
std::string inflated(const std::string& path, std::string_view compressed);

}  // namespace corral
