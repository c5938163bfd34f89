// SPDX-License-Identifier: BSD-3-Clause
// Compressed chunks of bags.
#pragma once

#include <string>
#include <vector>

#include "byte_readers.h"

namespace roomgraph::bags {

/// Content of a chunk compressed as "bz2", "lz4" (its frame format) or "zstd": at most `size` bytes, of which
/// memory is taken as they come. Throws BadMessage when the compression is unknown or the bytes are damaged;
/// `out` then has what came before.
void decompress(const std::string& compression, Bytes bytes, std::size_t size,
                std::vector<std::uint8_t>& out);

}  // namespace roomgraph::bags
