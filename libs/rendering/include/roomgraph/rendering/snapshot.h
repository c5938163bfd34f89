// SPDX-License-Identifier: BSD-3-Clause
// Off-screen picture of a semantic map as PNG.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/core/errors.h"
#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// This machine cannot render off-screen.
struct NoRenderer : RunError {
  using RunError::RunError;
};

enum class SnapshotView { kTop, kOrbit, kRobot };

struct SnapshotOptions {
  SnapshotView view = SnapshotView::kTop;
  int width = 1280, height = 960;
  std::string title;  ///< one line at the top; empty: none
};

/// Renders a semantic map off-screen (EGL, no display) into a PNG: occupancy, footprints and boxes in class
/// colours, labels, trajectory, scale. Throws RunError when the file cannot be written, NoRenderer when there
/// is no OpenGL.
void renderSnapshot(const CSemanticMap& map, const ObjectDatabase& database, const SnapshotOptions& options,
                    const std::filesystem::path& png);

}  // namespace roomgraph
