// SPDX-License-Identifier: BSD-3-Clause
// Drawn sizes of furniture and the arrangements they stand in.
#include "flat_groups.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace roomgraph {
namespace {

using Color = std::array<double, 3>;
using Size = Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

/// Sizes (w, d, h) of what can be bought, from catalogues' usual ranges; not those of objects.ini.
Size drawSize(const std::string& model, Random& random) {
  const auto draw = [&](double low, double high, double power = 1) { return drawSkewed(random, low, high, power); };
  const auto equal = [&](double w, double h) { return Size(w, w, h); };
  static const std::map<std::string, std::array<double, 6>> ranges{
      {"swivel_chair", {0.57, 0.75, 0.56, 0.74, 0.82, 1.24}}, {"wooden_chair", {0.4, 0.48, 0.42, 0.52, 0.82, 1.02}},
      {"visitor_chair", {0.48, 0.6, 0.5, 0.6, 0.78, 0.92}},   {"armchair", {0.72, 0.98, 0.74, 0.95, 0.72, 1.0}},
      {"desk", {1.2, 1.8, 0.65, 0.85, 0.71, 0.77}},           {"shelf", {0.6, 1.2, 0.26, 0.38, 0.9, 2.05}},
      {"cabinet", {0.4, 1.0, 0.4, 0.55, 0.6, 1.4}},           {"cupboard", {0.8, 1.2, 0.4, 0.6, 1.1, 2.0}},
      {"refrigerator", {0.55, 0.65, 0.58, 0.66, 1.4, 1.85}},  {"bench", {1.0, 1.7, 0.35, 0.5, 0.42, 0.5}},
      {"bed", {0.9, 1.8, 1.95, 2.1, 0.7, 1.05}},              {"monitor", {0.42, 0.66, 0.17, 0.22, 0.36, 0.5}},
      {"printer", {0.38, 0.52, 0.34, 0.46, 0.2, 0.4}},        {"box", {0.3, 0.6, 0.25, 0.45, 0.2, 0.45}},
      {"whiteboard", {1.0, 1.8, 0.04, 0.04, 0.9, 1.1}},       {"table", {1.2, 1.9, 0.75, 0.95, 0.72, 0.76}}};
  if (model == "sofa") return {draw(1.4, 2.4, 1.6), draw(0.75, 1.05, 0.6), draw(0.65, 0.95, 1.4)};
  if (model == "plant") return equal(draw(0.45, 0.8), draw(0.6, 1.6));
  if (model == "bin") return equal(draw(0.22, 0.34), draw(0.28, 0.6, 2));
  if (model == "stool") return equal(draw(0.32, 0.45), draw(0.42, 0.75, 1.6));
  if (model == "coat_stand") return equal(draw(0.45, 0.6), draw(1.65, 1.9));
  if (model == "round_table") return equal(draw(0.9, 1.3), draw(0.72, 0.76));
  const auto& range = ranges.at(model);
  const double w = draw(range[0], range[1]), d = draw(range[2], range[3]);
  return {w, d, draw(range[4], range[5])};
}

Color drawColor(const std::string& model, Random& random) {
  static const std::vector<Color> cloths{{0.13, 0.17, 0.28}, {0.12, 0.12, 0.13}, {0.45, 0.16, 0.14}, {0.2, 0.33, 0.48},
                                         {0.36, 0.38, 0.27}, {0.5, 0.46, 0.4},   {0.62, 0.42, 0.2}, {0.3, 0.2, 0.16},
                                         {0.55, 0.56, 0.58}, {0.7, 0.66, 0.58}};
  static const std::vector<Color> woods{{0.72, 0.56, 0.38}, {0.6, 0.42, 0.25}, {0.42, 0.28, 0.17}, {0.8, 0.72, 0.6},
                                        {0.85, 0.84, 0.82}, {0.3, 0.22, 0.17}};
  static const std::vector<Color> paints{{0.66, 0.67, 0.68}, {0.86, 0.86, 0.85}, {0.3, 0.32, 0.35}, {0.5, 0.55, 0.6}};
  static const std::vector<std::string> of_cloth{"swivel_chair", "sofa", "visitor_chair", "armchair", "stool"};
  static const std::vector<std::string> painted{"cabinet", "refrigerator", "bin", "printer"};
  const auto one_of = [&](const auto& names) { return std::find(names.begin(), names.end(), model) != names.end(); };
  if (one_of(of_cloth)) return pick(random, cloths);
  if (one_of(painted)) return pick(random, paints);
  if (model == "plant") return {random.uniform(0.15, 0.3), random.uniform(0.34, 0.5), random.uniform(0.12, 0.2)};
  if (model == "monitor") return {0.07, 0.07, 0.08};
  if (model == "box") return {0.68, 0.52, 0.35};
  if (model == "whiteboard") return {0.9, 0.9, 0.9};
  return pick(random, woods);
}

Furniture placed(Furniture item, double x, double y, double yaw, double z = 0) {
  item.at_m = {inSteps(x, 0.001), inSteps(y, 0.001), inSteps(z, 0.001)};
  item.yaw_rad = yaw;
  return item;
}

double width(const Furniture& item) {
  return item.size_m->x();
}
double depthOf(const Furniture& item) {
  return item.size_m->y();
}
double heightOf(const Furniture& item) {
  return item.size_m->z();
}

/// A chair in front of a desk whose edge is at x; it looks back at it and may reach below by `under` m.
Furniture chairAt(const std::string& model, double edge_x, double y, double under, Random& random) {
  Furniture chair = drawFurniture(model, random);
  const double turn = under > 0 ? 0 : std::clamp(0.35 * random.normal(), -0.7, 0.7);
  // A turned chair needs its diagonal.
  const double reach = depthOf(chair) / 2 * std::abs(std::cos(turn)) + width(chair) / 2 * std::abs(std::sin(turn));
  return placed(chair, edge_x + reach - under, y, kPi + turn);
}

/// The desk with what stands on and before it; the desk's back is at x = `back`, its user's side towards +x.
std::vector<Furniture> desk(double back, Random& random) {
  Furniture top = drawFurniture("desk", random);
  const double d = depthOf(top), w = width(top), h = heightOf(top), edge = back + d;
  std::vector<Furniture> out{placed(top, back + d / 2, 0, 0)};
  const double side = -0.12 * w;
  out.push_back(placed(drawFurniture("monitor", random), back + 0.3 * d, side, 0.1 * random.normal(), h));
  const bool wide = w >= 1.5;
  if (wide && random.chance(0.4))
    out.push_back(placed(drawFurniture("printer", random), back + 0.45 * d, w / 2 - 0.3, 0, h));
  else if (wide && random.chance(0.5))
    out.push_back(placed(drawFurniture("monitor", random), back + 0.3 * d, side + 0.68, -0.2, h));
  const double u = random.uniform();
  const std::string model = u < 0.78 ? "swivel_chair" : u < 0.86 ? "wooden_chair" : u < 0.94 ? "visitor_chair" : "stool";
  const bool tucked = random.chance(0.4);
  // Only seats without arms fit below as far as their middle.
  const double under = !tucked ? -random.uniform(0.02, 0.3)
                               : (model == "wooden_chair" || model == "stool") ? random.uniform(0.08, 0.2)
                                                                               : random.uniform(0.04, 0.14);
  out.push_back(chairAt(model, edge, side, under, random));
  return out;
}

}  // namespace

Furniture drawFurniture(const std::string& model, Random& random) {
  Furniture out;
  out.model = model;
  out.size_m = drawSize(model, random);
  out.color = drawColor(model, random);
  out.shape = drawInt(random, 1, 99999);
  return out;
}

FurnitureGroup atWall(const Furniture& item, double gap_m) {
  return {{placed(item, depthOf(item) / 2 + gap_m, 0, 0)}, true, false};
}

FurnitureGroup standsAlone(Furniture item) {
  return {{item}, false, false};
}

FurnitureGroup deskGroup(Random& random) {
  FurnitureGroup out{desk(0.02, random), true, random.chance(0.4)};
  const Furniture& top = out.items.front();
  if (random.chance(0.6)) {
    const Furniture thing = drawFurniture(random.chance(0.6) ? "bin" : "box", random);
    const double side = random.chance(0.5) ? 1 : -1;
    out.items.push_back(placed(thing, 0.04 + depthOf(thing) / 2, side * (width(top) / 2 + width(thing) / 2 + 0.06), 0));
  }
  return out;
}

FurnitureGroup deskBlock(Random& random) {
  FurnitureGroup out{desk(0.01, random), false, false};
  for (auto item : desk(0.01, random)) {
    item.at_m = {-item.at_m.x(), -item.at_m.y(), item.at_m.z()};
    item.yaw_rad += kPi;
    out.items.push_back(item);
  }
  return out;
}

FurnitureGroup sofaGroup(Random& random) {
  FurnitureGroup out{{}, true, random.chance(0.5)};
  const Furniture sofa = drawFurniture("sofa", random);
  const double d = depthOf(sofa), w = width(sofa);
  out.items.push_back(placed(sofa, d / 2 + 0.03, 0, 0));
  Furniture table = drawFurniture("table", random);
  table.size_m = Size(drawSkewed(random, 0.8, 1.2, 1), drawSkewed(random, 0.5, 0.65, 1), drawSkewed(random, 0.38, 0.48, 1));
  if (random.chance(0.65)) out.items.push_back(placed(table, d + 0.38 + depthOf(table) / 2, 0, 0));
  const double side = random.chance(0.5) ? 1 : -1;
  const double u = random.uniform();
  if (u < 0.45) {
    const Furniture chair = drawFurniture("armchair", random);
    out.items.push_back(placed(chair, d / 2 + 0.55, side * (w / 2 + 0.2 + depthOf(chair) / 2 + 0.1), -side * kPi / 2));
  } else if (u < 0.7) {
    const Furniture plant = drawFurniture("plant", random);
    out.items.push_back(placed(plant, width(plant) / 2 + 0.06, side * (w / 2 + width(plant) / 2 + 0.08), 0));
  }
  return out;
}

FurnitureGroup diningGroup(bool meeting, Random& random) {
  FurnitureGroup out{{}, false, false};
  const bool round = random.chance(0.45);
  const Furniture table = drawFurniture(round ? "round_table" : "table", random);
  const double w = width(table), d = depthOf(table);
  const double u = random.uniform();
  const std::string model = meeting ? (u < 0.6 ? "swivel_chair" : "visitor_chair")
                                    : (u < 0.65 ? "wooden_chair" : u < 0.85 ? "visitor_chair" : "stool");
  out.items.push_back(placed(table, 0, 0, 0));
  const auto add = [&](double direction, double edge, double along) {
    if (random.chance(0.12)) return;
    const Furniture chair = drawFurniture(model, random);
    const double out_m = edge + depthOf(chair) / 2 - random.uniform(-0.2, 0.1);
    const Pose2 place = Pose2{0, 0, direction} * Pose2{out_m, along, kPi};
    out.items.push_back(placed(chair, place.x, place.y, wrapAngle(place.yaw)));
  };
  if (round) {
    const int seats = drawInt(random, 3, 4);
    for (int i = 0; i < seats; ++i) add(2 * kPi * i / seats, w / 2, 0);
    return out;
  }
  const int per_side = w > 1.55 ? 2 : 1;
  for (const double direction : {0.0, kPi})
    for (int i = 0; i < per_side; ++i) add(direction, d / 2, per_side == 1 ? 0.0 : (i - 0.5) * 0.78);
  for (const double direction : {kPi / 2, -kPi / 2})
    if (random.chance(0.5)) add(direction, w / 2, 0);
  return out;
}

FurnitureGroup caseRow(Random& random) {
  FurnitureGroup out{{}, true, random.chance(0.6)};
  const int count = drawInt(random, 1, 3);
  double y = 0;
  for (int i = 0; i < count; ++i) {
    const double u = random.uniform();
    const Furniture item =
        drawFurniture(u < 0.4 ? "shelf" : u < 0.7 ? "cabinet" : u < 0.9 ? "cupboard" : "refrigerator", random);
    y += width(item) / 2;
    out.items.push_back(placed(item, depthOf(item) / 2 + 0.02, y, 0));
    if (heightOf(item) < 1.25 && item.model == "cabinet" && width(item) > 0.5 && random.chance(0.6)) {
      Furniture printer = drawFurniture("printer", random);
      printer.size_m->y() = std::min(depthOf(printer), depthOf(item) - 0.02);
      printer.size_m->x() = std::min(width(printer), width(item) - 0.04);
      out.items.push_back(placed(printer, depthOf(item) / 2 + 0.02, y, 0, heightOf(item)));
    }
    y += width(item) / 2 + random.uniform(0.01, 0.12);
  }
  for (auto& item : out.items) item.at_m.y() -= inSteps(y / 2, 0.001);
  return out;
}

FurnitureGroup chairRow(Random& random) {
  FurnitureGroup out{{}, true, random.chance(0.3)};
  const int count = drawInt(random, 2, 4);
  const double u = random.uniform();
  const std::string model = u < 0.35 ? "swivel_chair" : u < 0.75 ? "visitor_chair" : "wooden_chair";
  const Furniture same = drawFurniture(model, random);
  double y = 0;
  for (int i = 0; i < count; ++i) {
    const Furniture chair = model == "swivel_chair" ? drawFurniture(model, random) : same;
    y += width(chair) / 2;
    const double turn = model == "swivel_chair" ? std::clamp(0.15 * random.normal(), -0.3, 0.3) : 0;
    out.items.push_back(placed(chair, depthOf(chair) / 2 + 0.12, y, turn));
    y += width(chair) / 2 + random.uniform(0.12, 0.3);
  }
  for (auto& item : out.items) item.at_m.y() -= inSteps(y / 2, 0.001);
  return out;
}

FurnitureGroup backToBack(Random& random) {
  FurnitureGroup out{{}, false, false};
  const bool sofas = random.chance(0.6);
  const int per_side = sofas ? 1 : drawInt(random, 2, 3);
  for (const double side : {1.0, -1.0}) {
    double y = 0;
    for (int i = 0; i < per_side; ++i) {
      const Furniture seat = drawFurniture(sofas ? "sofa" : "visitor_chair", random);
      if (i > 0) y += width(seat) / 2 + 0.05;
      out.items.push_back(placed(seat, side * (depthOf(seat) / 2 + 0.02), y - (per_side - 1) * 0.3, side > 0 ? 0 : kPi));
      y += width(seat) / 2;
    }
  }
  return out;
}

FurnitureGroup whiteboardOnWall(Random& random) {
  const Furniture board = drawFurniture("whiteboard", random);
  return {{placed(board, 0.022, 0, 0, 0.9)}, true, false};
}

}  // namespace roomgraph
