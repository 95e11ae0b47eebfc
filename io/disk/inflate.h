// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace corral {

/// What a gzip file holds, all its members one after another. Memory grows with what comes out, never by what the file
/// promises; a file of which more comes out than 64 MiB and 100 times its own size is no mesh, and refused.
/// Throws    IoError that names the file and the byte: not gzip, cut short, damaged, too large.
std::string inflated(const std::string& path, std::string_view compressed);

/// The content of a member of a zip archive, which states its size: no more comes out, and a size that deflate cannot reach
/// from these bytes, or that is above the limit of inflated(), is refused before there is memory for it. Throws as inflated().
std::string inflated_member(const std::string& path, std::string_view compressed, std::size_t size);

/// CRC-32, as zip and gzip state it.
std::uint32_t checksum_of(std::string_view content);

}  // namespace corral
