// SPDX-License-Identifier: BSD-3-Clause
// Parameters of object classes, reading of objects.ini and lookup by label.
#include "roomgraph/observations/object_database.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "roomgraph/core/errors.h"
#include "roomgraph/geometry/shape_math.h"

namespace roomgraph {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

const IniEntry* entryOf(const Config& config, const std::string& section, const std::string& key) {
  for (const auto& entry : config.entries())
    if (entry.section == section && entry.key == key) return &entry;
  return nullptr;
}

ObjectModel readModel(const Config& config, const IniEntry& first) {
  ObjectModel model;
  model.class_name = first.section;
  config.read(first.section, model);
  const IniEntry* generator = entryOf(config, first.section, "generator");
  model.place = (generator ? *generator : first).place + ": [" + first.section + "]";
  // What is never mapped most likely moves: a file need not say both.
  if (!entryOf(config, first.section, "moves")) model.moves = !model.landmark;
  if (model.moves && model.landmark)
    throw ConfigError(model.place + " moves: what moves by itself is no landmark; set landmark = false");
  if (const IniEntry* front = entryOf(config, first.section, "front");
      front && model.front == "high_back" && model.shape != "cuboid")
    throw ConfigError(front->place + ": [" + first.section + "] front = high_back: only a cuboid has a back");
  return model;
}

}  // namespace

void ObjectModel::declareParameters(ParameterVisitor& v) {
  v.add("labels", labels, {.doc = "Labels of detectors that mean this class."});
  v.add("shape", shape,
        {.doc = "Shape that models the object.", .choices = {"cylinder", "cuboid", "planar"}});
  v.add("width_m", width_m, {.doc = "Usual width, from side to side.", .unit = "m", .min = 0.01, .max = 20});
  v.add("depth_m", depth_m, {.doc = "Usual depth, from front to back.", .unit = "m", .min = 0.01, .max = 20});
  v.add("height_m", height_m, {.doc = "Usual height.", .unit = "m", .min = 0.01, .max = 20});
  v.add("width_sigma_m", width_sigma_m,
        {.doc = "Standard deviation of the width among objects of this class.",
         .unit = "m",
         .min = 0,
         .max = 10});
  v.add("depth_sigma_m", depth_sigma_m,
        {.doc = "Standard deviation of the depth among objects of this class.",
         .unit = "m",
         .min = 0,
         .max = 10});
  v.add("height_sigma_m", height_sigma_m,
        {.doc = "Standard deviation of the height among objects of this class.",
         .unit = "m",
         .min = 0,
         .max = 10});
  v.add("place_sigma_m", place_sigma_m,
        {.doc = "How far the middle of such an object is from that of its shape, standard deviation along x and y: part of "
                "the uncertainty of its place in the map, however often it was seen.",
         .unit = "m",
         .min = 0,
         .max = 1});
  v.add(
      "symmetry", symmetry,
      {.doc = "Symmetry of yaw: 0 any angle, 1 none, 2 half a turn, 4 a quarter turn.", .min = 0, .max = 4});
  v.add("rests_on_ground", rests_on_ground, {.doc = "Whether the object stands on the floor."});
  v.add("front", front,
        {.doc =
             "Which side is the front of a shape with symmetry 1: high_back: the one away from the highest "
             "part (seats); near_side: of the sides that fit the size, the one that is seen (furniture along "
             "walls); none: nothing tells it.",
         .choices = {"high_back", "near_side", "none"}});
  v.add(
      "solid_share", solid_share,
      {.doc = "Share of the height, from the floor, through which no lidar beam passes: beams that do speak "
              "against the object; 0: beams may pass (legs, an open door).",
       .min = 0,
       .max = 1});
  v.add("moves", moves,
        {.doc = "The object moves by itself: it is kept out of odometry, scans and map; not set: true where "
                "landmark is false."});
  v.add("landmark", landmark, {.doc = "Whether the object is mapped. false: it is detected, never mapped."});
  v.add("generator", generator,
        {.doc = "Shape generator that makes this class's shapes, by class name; auto: CylinderGenerator, "
                "CuboidGenerator or DoorGenerator (planar), by the shape."});
  v.add("color", color, {.doc = "Colour in pictures, #rrggbb."});
}

ObjectShape ObjectModel::nominal() const {
  return {shapeKindFromString(shape), width_m, depth_m, height_m};
}

Eigen::Vector3d ObjectModel::sizeSigma() const {
  constexpr double kLeast_m = 0.01;
  return Eigen::Vector3d(width_sigma_m, depth_sigma_m, height_sigma_m).cwiseMax(kLeast_m);
}

double ObjectModel::sizeDistance2(const ObjectShape& other) const {
  const Eigen::Vector3d d = (sizeOf(other) - sizeOf(nominal())).cwiseQuotient(sizeSigma());
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

FrontRule ObjectModel::frontRule() const {
  if (symmetry != 1 || nominal().kind == ShapeKind::kCylinder) return FrontRule::kNone;
  static const std::map<std::string, FrontRule> rules{{"high_back", FrontRule::kHighBack},
                                                      {"near_side", FrontRule::kNearSide},
                                                      {"none", FrontRule::kNone}};
  return rules.at(front);
}

std::string ObjectModel::generatorName() const {
  if (generator != "auto") return generator;
  switch (nominal().kind) {
    case ShapeKind::kCylinder:
      return "CylinderGenerator";
    case ShapeKind::kPlanar:
      return "DoorGenerator";
    case ShapeKind::kCuboid:
      break;
  }
  return "CuboidGenerator";
}

ObjectDatabase ObjectDatabase::fromFile(const std::filesystem::path& file) {
  return fromConfig(Config::fromFile(file));
}

ObjectDatabase ObjectDatabase::fromText(const std::string& text, const std::string& name) {
  return fromConfig(Config::fromText(text, name));
}

ObjectDatabase ObjectDatabase::fromConfig(const Config& config) {
  ObjectDatabase database;
  ConfigSchema schema;
  for (const auto& entry : config.entries()) {
    if (database.find(entry.section)) continue;
    ObjectModel defaults;
    schema.add(entry.section, defaults);
    const ObjectModel model = readModel(config, entry);
    for (const auto& label : model.labels)
      if (const ObjectModel* other = database.byLabel(label))
        throw ConfigError(model.place + " labels: '" + label + "' means [" + other->class_name + "] already");
    database.models_.push_back(model);
  }
  schema.check(config);
  return database;
}

const ObjectModel* ObjectDatabase::find(const std::string& class_name) const {
  for (const auto& model : models_)
    if (model.class_name == class_name) return &model;
  return nullptr;
}

const ObjectModel* ObjectDatabase::byLabel(const std::string& label) const {
  const std::string wanted = lower(label);
  for (const auto& model : models_)
    for (const auto& known : model.labels)
      if (lower(known) == wanted) return &model;
  return nullptr;
}

bool ObjectDatabase::moves(const std::string& class_name) const {
  const ObjectModel* model = find(class_name);
  return model && model->moves;
}

std::string ObjectDatabase::markdown() {
  ObjectModel model;
  ConfigSchema schema;
  schema.add("class name", model);
  return schema.markdown();
}

}  // namespace roomgraph
