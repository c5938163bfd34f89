// SPDX-License-Identifier: BSD-3-Clause
// Boxes of an image as lines of an OpenGL scene.
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "roomgraph/observations/CObservationDetections.h"

namespace roomgraph {
namespace {

using mrpt::img::TColor;

// Okabe and Ito's colours but yellow and black, which are hard to see on white.
constexpr TColor kBoxColors[] = {{230, 159, 0}, {86, 180, 233}, {0, 158, 115},
                                 {0, 114, 178}, {213, 94, 0},   {204, 121, 167}};

constexpr double kDrawnWidth_m = 10;

// The same label has the same colour in every image: FNV-1a, as std::hash differs between libraries.
TColor colorOfLabel(const std::string& label) {
  std::uint32_t hash = 0x811c9dc5U;
  for (const unsigned char c : label) hash = (hash ^ c) * 0x01000193U;
  return kBoxColors[hash % std::size(kBoxColors)];
}

// From pixels to an upright picture, as wide as the first view of RawLogViewer shows it.
struct Picture {
  double width_px, height_px;
  mrpt::math::TPoint3D at(double u, double v) const {
    const double scale = kDrawnWidth_m / width_px;
    return {(u - width_px / 2) * scale, 0, (height_px / 2 - v) * scale};
  }
};

mrpt::opengl::CSetOfLines::Ptr rectangle(const Picture& picture, double u0, double v0, double u1, double v1,
                                         TColor color) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  const std::array corners = {picture.at(u0, v0), picture.at(u1, v0), picture.at(u1, v1), picture.at(u0, v1)};
  for (std::size_t i = 0; i < corners.size(); ++i)
    lines->appendLine(mrpt::math::TSegment3D(corners[i], corners[(i + 1) % corners.size()]));
  lines->setColor_u8(color);
  lines->setLineWidth(2);
  return lines;
}

}  // namespace

void CObservationDetections::getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const {
  double width = image_width, height = image_height;
  for (const Item& item : items) {  // of a record that does not say how large its image is
    if (image_width == 0) width = std::max(width, item.u_max);
    if (image_height == 0) height = std::max(height, item.v_max);
  }
  const Picture picture{std::max(width, 1.0), std::max(height, 1.0)};
  auto frame = rectangle(picture, 0, 0, picture.width_px, picture.height_px, {160, 160, 160});
  frame->setName("image");
  out.insert(frame);
  for (const Item& item : items) {
    auto box = rectangle(picture, item.u_min, item.v_min, item.u_max, item.v_max, colorOfLabel(item.label));
    box->setName(item.label);
    out.insert(box);
    char score[16];
    std::snprintf(score, sizeof score, " %.2f", item.score);
    auto text = mrpt::opengl::CText::Create(item.label + score);
    text->setLocation(picture.at(item.u_min, item.v_min));
    text->setColor_u8(colorOfLabel(item.label));
    out.insert(text);
  }
}

}  // namespace roomgraph
