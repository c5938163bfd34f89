// SPDX-License-Identifier: BSD-3-Clause
// Floor plan in DXF (release 12, text), drawing units metres.
#include <cctype>

#include "drawing.h"
#include "exporters.h"
#include "roomgraph/maptools/grid_outlines.h"
#include "text_numbers.h"

namespace roomgraph {
namespace {

constexpr double kLetterHeight_m = 0.12;
constexpr int kWhite = 7, kGray = 8, kMagenta = 6, kFirstClassColor = 1, kClassColors = 5;

/// Pairs of a group code and a value, one a line each.
class DxfText {
 public:
  DxfText& add(int code, const std::string& value) {
    text_ += std::to_string(code) + "\n" + value + "\n";
    return *this;
  }
  DxfText& point(const Eigen::Vector2d& at, int shift = 0) {
    return add(10 + shift, decimals(at.x(), 4)).add(20 + shift, decimals(at.y(), 4)).add(30 + shift, "0.0");
  }
  void polyline(const Polygon2& corners, const std::string& layer, bool closed) {
    add(0, "POLYLINE").add(8, layer).add(66, "1").point({0, 0}).add(70, closed ? "1" : "0");
    for (const auto& corner : corners) add(0, "VERTEX").add(8, layer).point(corner);
    add(0, "SEQEND").add(8, layer);
  }
  void label(const Eigen::Vector2d& at, const std::string& words, const std::string& layer) {
    add(0, "TEXT").add(8, layer).point(at).add(40, decimals(kLetterHeight_m)).add(1, words);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Release 12 allows capital letters, digits, $, - and _ in names.
std::string layerName(const std::string& class_name) {
  std::string name;
  for (const char c : class_name)
    name += std::isalnum(static_cast<unsigned char>(c))
                ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                : '_';
  return "OBJECT_" + name;
}

std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return out;
}

void addHeader(const Eigen::AlignedBox2d& bounds, DxfText& dxf) {
  dxf.add(0, "SECTION").add(2, "HEADER").add(9, "$ACADVER").add(1, "AC1009");
  dxf.add(9, "$INSUNITS").add(70, "6");  // metres
  dxf.add(9, "$EXTMIN").point(bounds.min()).add(9, "$EXTMAX").point(bounds.max());
  dxf.add(0, "ENDSEC");
}

void addLayers(const std::vector<std::pair<std::string, int>>& layers, DxfText& dxf) {
  dxf.add(0, "SECTION")
      .add(2, "TABLES")
      .add(0, "TABLE")
      .add(2, "LAYER")
      .add(70, std::to_string(layers.size()));
  for (const auto& [name, color] : layers)
    dxf.add(0, "LAYER").add(2, name).add(70, "0").add(62, std::to_string(color)).add(6, "CONTINUOUS");
  dxf.add(0, "ENDTAB").add(0, "ENDSEC");
}

}  // namespace

std::string dxfText(const CSemanticMap& map) {
  std::vector<std::pair<std::string, int>> layers{{"WALLS", kWhite}, {"PATH", kMagenta}, {"LABELS", kGray}};
  for (const auto& name : classesOf(map))
    layers.emplace_back(layerName(name), kFirstClassColor + static_cast<int>(layers.size()) % kClassColors);
  DxfText dxf;
  addHeader(drawingBounds(map), dxf);
  addLayers(layers, dxf);
  dxf.add(0, "SECTION").add(2, "ENTITIES");
  if (map.occupancy)
    for (const auto& wall : simplified(outlinesOf(*map.occupancy, isOccupiedCell), outlineTolerance(*map.occupancy)))
      dxf.polyline(wall, "WALLS", true);
  for (const auto& landmark : map.landmarks) {
    dxf.polyline(footprintOf(landmark), layerName(landmark.class_name), true);
    dxf.label(landmark.position.head<2>(),
              plain(landmark.class_name + " " + std::to_string(landmark.id.value)), "LABELS");
  }
  for (const auto& piece : pathPieces(map))
    if (piece.size() > 1) dxf.polyline(piece, "PATH", false);
  return dxf.text() + "0\nENDSEC\n0\nEOF\n";
}

}  // namespace roomgraph
