// SPDX-License-Identifier: BSD-3-Clause
// Differences as JSON and as a drawing.
#include <nlohmann/json.hpp>

#include "drawing.h"
#include "roomgraph/maptools/map_difference.h"
#include "text_numbers.h"

namespace roomgraph {
namespace {

nlohmann::ordered_json placeJson(const std::optional<Landmark>& landmark) {
  if (!landmark) return nullptr;
  return {
      {"id", landmark->id.value},
      {"x", landmark->position.x()},
      {"y", landmark->position.y()},
      {"yaw", landmark->has_yaw ? nlohmann::ordered_json(landmark->yaw) : nlohmann::ordered_json(nullptr)},
      {"existence", landmark->existence}};
}

const char* inkOf(ObjectChange change) {
  switch (change) {
    case ObjectChange::kMoved:
      return "#1f5fbf";
    case ObjectChange::kVanished:
      return "#c0392b";
    case ObjectChange::kAppeared:
      return "#1e8449";
    case ObjectChange::kUnsure:
      return "#b7791f";
    case ObjectChange::kStayed:
      break;
  }
  return "#707a86";
}

std::string colored(const std::string& ink, bool dashed) {
  return "fill=\"" + ink + "\" stroke=\"" + ink + "\"" +
         (dashed ? " fill-opacity=\"0.08\" stroke-dasharray=\"0.12 0.08\"" : " fill-opacity=\"0.35\"");
}

void drawArrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& ink,
               SvgDrawing& drawing) {
  const Eigen::Vector2d along = (to - from).normalized(), across(-along.y(), along.x());
  drawing.polyline({from, to}, "stroke=\"" + ink + "\"");
  drawing.polygon({to, to - 0.2 * along + 0.08 * across, to - 0.2 * along - 0.08 * across},
                  "fill=\"" + ink + "\" stroke=\"none\"");
}

void drawChange(const ObjectDifference& one, SvgDrawing& drawing) {
  const std::string ink = inkOf(one.change);
  const Landmark& shown = one.after ? *one.after : *one.before;
  const std::string words =
      shown.class_name + (one.change == ObjectChange::kStayed
                              ? ""
                              : " " + toString(one.change) + " " + decimals(one.probability, 2));
  if (one.before && one.change != ObjectChange::kStayed)
    drawing.polygon(footprintOf(*one.before), colored(ink, true), words);
  if (one.after)
    drawing.polygon(footprintOf(*one.after), colored(ink, one.change == ObjectChange::kUnsure), words);
  if (one.before && one.after && one.change == ObjectChange::kMoved)
    drawArrow(one.before->position.head<2>(), one.after->position.head<2>(), ink, drawing);
  drawing.text(shown.position.head<2>() - Eigen::Vector2d(0, 0.04),
               one.change == ObjectChange::kStayed ? 0.1 : 0.15, words, "fill=\"#262e3a\" stroke=\"none\"");
}

}  // namespace

std::string differenceJson(const std::vector<ObjectDifference>& difference) {
  nlohmann::ordered_json objects = nlohmann::ordered_json::array();
  for (const auto& one : difference)
    objects.push_back({{"change", toString(one.change)},
                       {"probability", one.probability},
                       {"seen", one.seen},
                       {"class", (one.before ? one.before : one.after)->class_name},
                       {"before", placeJson(one.before)},
                       {"after", placeJson(one.after)}});
  const nlohmann::ordered_json json{{"objects", objects}};
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string differenceSvg(const CSemanticMap& before, const CSemanticMap& after,
                          const std::vector<ObjectDifference>& difference, double scale) {
  SvgDrawing drawing(drawingBounds(before).merged(drawingBounds(after)), scale);
  drawFloor(after, drawing);
  drawing.beginGroup("changes", "stroke-width=\"0.03\"");
  // What changed lies above what did not.
  for (const bool stayed : {true, false})
    for (const auto& one : difference)
      if ((one.change == ObjectChange::kStayed) == stayed) drawChange(one, drawing);
  drawing.endGroup();
  drawing.scaleBar();
  return drawing.finished();
}

}  // namespace roomgraph
