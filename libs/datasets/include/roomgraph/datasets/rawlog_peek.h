// SPDX-License-Identifier: BSD-3-Clause
// Look at the beginning of a rawlog: whether it holds RGB-D frames and detections.
#pragma once

#include <filesystem>

namespace roomgraph {

/// What the beginning of a rawlog holds.
struct RawlogPeek {
  bool frames = false;      ///< RGB-D records
  bool detections = false;  ///< recorded boxes
  bool whole = false;       ///< the file has no more than what was looked at
};

/// Looks at the first 20000 records or 128 MiB (uncompressed), whichever ends first, without decoding images;
/// ends early when there are both. Time stamps, which may be wrong, play no part. Throws InputError like
/// RawlogReader.
RawlogPeek peekRawlog(const std::filesystem::path& file);

}  // namespace roomgraph
