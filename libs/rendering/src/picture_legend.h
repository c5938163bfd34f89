// SPDX-License-Identifier: BSD-3-Clause
// Legend of rendered pictures: classes, walls and path in rows at the bottom.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "map_picture.h"
#include "roomgraph/observations/object_database.h"
#include "roomgraph/rendering/palette.h"

namespace roomgraph {

/// A word of the legend and the swatch before it.
struct PictureLegendEntry {
  std::string text;
  palette::TColor color, rim;
  bool begins_group = false;  ///< stands off a little
  bool is_path = false;       ///< a swatch that runs from the path's first colour to its last
  double u = 0;          ///< left end, px
  std::size_t row = 0;   ///< 0: the lowest
  std::string longest{};  ///< text that there must be room for, as counts grow in a film
};

/// All entries of a picture in rows that leave room for the scale on the right; most of them when they would fill more
/// than half of the picture, with how many are left out as the last. `unit_px`: height of a capital letter.
struct PictureLegend {
  PictureLegend(const MapPicture& picture, const ObjectDatabase& database, const cv::Size& size, double unit_px);
  void draw(cv::Mat& image) const;
  std::size_t rows() const { return entries.empty() ? 1 : entries.front().row + 1; }

  double unit_px;
  std::vector<PictureLegendEntry> entries;  ///< from the highest row down
};

}  // namespace roomgraph
