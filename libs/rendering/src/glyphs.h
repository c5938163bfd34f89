// SPDX-License-Identifier: BSD-3-Clause
// Anti-aliased text from MRPT's outline font.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>

#include "roomgraph/rendering/palette.h"

namespace roomgraph {

/// Text from MRPT's built-in outline font (no font files needed), anti-aliased; with other letters than those of ASCII
/// from DejaVu Sans.
struct TextStyle {
  double cap_height_px = 10;  ///< height of a capital letter
  palette::TColor color = palette::kInk;
  double halo_px = 0;  ///< white rim around the letters; 0: none
};

/// Width of the text, px.
double textWidth(const std::string& text, const TextStyle& style);
/// Draws the text with the left end of its base line at `base` (px) into a BGR image.
void drawText(cv::Mat& image, const std::string& text, const Eigen::Vector2d& base, const TextStyle& style);

}  // namespace roomgraph
