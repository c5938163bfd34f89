// SPDX-License-Identifier: BSD-3-Clause
// What a window shows, as a picture.
#pragma once

#include <filesystem>

namespace roomgraph {

/// Writes what was drawn and not shown yet, width x height px, as PNG. Throws RunError.
void saveBackBuffer(int width, int height, const std::filesystem::path& png);

/// NAME_1.png, or the first number that is free.
std::filesystem::path freePicture(const std::string& name);

}  // namespace roomgraph
