// SPDX-License-Identifier: BSD-3-Clause
// The occupancy grid as a picture for the page.
#pragma once

#include <filesystem>

#include "run_data.h"

namespace roomgraph {

/// From map.yaml and its image. A grid of more than `most_cells` is made coarser; what is occupied stays so.
/// Throws InputError.
GridImage readGridImage(const std::filesystem::path& yaml, double most_cells = 4e6);

}  // namespace roomgraph
