// SPDX-License-Identifier: BSD-3-Clause
// Figures of a map for papers and pages: from above, as PDF, SVG or PNG.
#pragma once

#include <filesystem>
#include <string>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

enum class FigureStyle {
  kScreen,  ///< as the rendered pictures look from above
  kPaper    ///< white, thin lines, a symbol for each class: legible in print, without colours too
};

struct FigureOptions {
  FigureStyle style = FigureStyle::kPaper;
  int width = 1280, height = 960;  ///< px of 1/96 inch; figures in paper style end where the map ends
  std::string title;               ///< one line at the top; empty: none
};

/// px of 1/96 inch.
struct FigureSize {
  int width = 0, height = 0;
};

/// Draws a map from above: walls and free space, objects as footprints in class colours, doors dashed, path,
/// legend, scale bar. The ending (.pdf, .svg, .png) is the format. The same map gives the same bytes. Returns
/// how large it became. Throws RunError when the file cannot be written, std::invalid_argument for another
/// ending.
FigureSize writeFigure(const CSemanticMap& map, const ObjectDatabase& database, const FigureOptions& options,
                       const std::filesystem::path& file);

}  // namespace roomgraph
