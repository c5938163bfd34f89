// SPDX-License-Identifier: BSD-3-Clause
// SHA-256 of texts and files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace roomgraph {

/// 64 hexadecimal digits in lower case.
std::string sha256Of(std::string_view bytes);
/// Throws InputError when the file cannot be read.
std::string sha256OfFile(const std::filesystem::path& file);

}  // namespace roomgraph
