// SPDX-License-Identifier: BSD-3-Clause
// What rooms of different use hold.
#include "flat_groups.h"

namespace roomgraph {
namespace {

using Groups = std::vector<FurnitureGroup>;

/// Small things that stand about.
void addClutter(Groups& out, int count, Random& random) {
  static const std::vector<std::string> at_walls{"plant", "bin", "box", "cabinet", "coat_stand", "stool", "wooden_chair",
                                                 "armchair", "shelf", "plant", "box"};
  for (int i = 0; i < count; ++i) {
    const std::string model = pick(random, at_walls);
    FurnitureGroup group = atWall(drawFurniture(model, random), model == "shelf" ? 0.02 : random.uniform(0.03, 0.15));
    group.fills_corner = random.chance(0.4);
    out.push_back(group);
  }
}

void addOffice(Groups& out, double area_m2, Random& random) {
  const bool block = area_m2 > 15 && random.chance(0.5);
  if (block) out.push_back(deskBlock(random));
  const int desks = std::max(1, static_cast<int>(area_m2 / 9) - (block ? 1 : 0) + drawInt(random, 0, 1));
  for (int i = 0; i < desks; ++i) out.push_back(deskGroup(random));
  out.push_back(caseRow(random));
  if (random.chance(0.4)) out.push_back(whiteboardOnWall(random));
  if (random.chance(0.6)) out.push_back(standsAlone(drawFurniture("swivel_chair", random)));
  if (random.chance(0.2)) out.push_back(sofaGroup(random));
}

void addLiving(Groups& out, double area_m2, Random& random) {
  out.push_back(sofaGroup(random));
  if (area_m2 > 14 && random.chance(0.6)) out.push_back(sofaGroup(random));
  if (area_m2 > 16 && random.chance(0.5)) out.push_back(diningGroup(false, random));
  out.push_back(caseRow(random));
  if (random.chance(0.4)) out.push_back(deskGroup(random));
  if (random.chance(0.5)) out.push_back(atWall(drawFurniture("armchair", random), 0.1));
}

void addMeeting(Groups& out, Random& random) {
  out.push_back(diningGroup(random.chance(0.75), random));
  out.push_back(whiteboardOnWall(random));
  if (random.chance(0.6)) out.push_back(chairRow(random));
  if (random.chance(0.6)) out.push_back(caseRow(random));
  if (random.chance(0.25)) out.push_back(sofaGroup(random));
}

void addLounge(Groups& out, double area_m2, Random& random) {
  if (area_m2 > 15 && random.chance(0.7)) out.push_back(backToBack(random));
  out.push_back(sofaGroup(random));
  out.push_back(chairRow(random));
  if (random.chance(0.6)) out.push_back(atWall(drawFurniture("bench", random), 0.04));
  if (random.chance(0.4)) out.push_back(diningGroup(false, random));
}

void addBedroom(Groups& out, Random& random) {
  out.push_back(atWall(drawFurniture("bed", random), 0.02));
  out.back().fills_corner = random.chance(0.5);
  out.push_back(caseRow(random));
  if (random.chance(0.7)) out.push_back(deskGroup(random));
  if (random.chance(0.5)) out.push_back(atWall(drawFurniture("armchair", random), 0.1));
}

}  // namespace

std::vector<FurnitureGroup> groupsFor(RoomUse use, double area_m2, Random& random) {
  Groups out;
  switch (use) {
    case RoomUse::kCorridor:
      if (random.chance(0.5)) out.push_back(atWall(drawFurniture("bench", random), 0.03));
      if (random.chance(0.5)) out.push_back(atWall(drawFurniture("coat_stand", random), 0.04));
      if (random.chance(0.5)) out.push_back(atWall(drawFurniture("plant", random), 0.05));
      if (random.chance(0.4)) out.push_back(atWall(drawFurniture("shelf", random), 0.02));
      if (random.chance(0.3)) out.push_back(atWall(drawFurniture("visitor_chair", random), 0.05));
      return out;
    case RoomUse::kOffice:
      addOffice(out, area_m2, random);
      break;
    case RoomUse::kLiving:
      addLiving(out, area_m2, random);
      break;
    case RoomUse::kMeeting:
      addMeeting(out, random);
      break;
    case RoomUse::kLounge:
      addLounge(out, area_m2, random);
      break;
    case RoomUse::kBedroom:
      addBedroom(out, random);
      break;
  }
  addClutter(out, drawInt(random, 2, 5), random);
  return out;
}

}  // namespace roomgraph
