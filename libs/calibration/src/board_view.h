// SPDX-License-Identifier: BSD-3-Clause
// Search for a chessboard in an image.
#pragma once

#include <optional>

#include "evidence.h"
#include "roomgraph/calibration/board.h"
#include "roomgraph/observations/frame.h"

namespace roomgraph {

/// The board in an image that shows all of it; nothing otherwise. Lengths come from its squares and the camera's intrinsics
/// (perspective-n-point), not from depth.
std::optional<BoardView> findBoard(const Frame& frame, const Board& board);

}  // namespace roomgraph
