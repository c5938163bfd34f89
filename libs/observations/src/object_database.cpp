// SPDX-License-Identifier: BSD-3-Clause
// Parameters of object classes, reading of objects.ini and lookup by label.
#include "roomgraph/observations/object_database.h"

#include <algorithm>
#include <cctype>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

void ObjectModel::declareParameters(ParameterVisitor& v) {
  v.add("labels", labels, {.doc = "detector labels this class answers to"});
  v.add("shape", shape, {.doc = "model of the object", .choices = {"cylinder", "cuboid", "planar"}});
  v.add("width_m", width_m, {.doc = "nominal lateral size", .unit = "m", .min = 0.01, .max = 20});
  v.add("depth_m", depth_m, {.doc = "nominal size front to back", .unit = "m", .min = 0.01, .max = 20});
  v.add("height_m", height_m, {.doc = "nominal height", .unit = "m", .min = 0.01, .max = 20});
  v.add("width_sigma_m", width_sigma_m,
        {.doc = "standard deviation of the width", .unit = "m", .min = 0, .max = 10});
  v.add("depth_sigma_m", depth_sigma_m,
        {.doc = "standard deviation of the depth", .unit = "m", .min = 0, .max = 10});
  v.add("height_sigma_m", height_sigma_m,
        {.doc = "standard deviation of the height", .unit = "m", .min = 0, .max = 10});
  v.add("symmetry", symmetry,
        {.doc = "yaw symmetry: 0 any angle, 1 none, 2 by 180 deg, 4 by 90 deg", .min = 0, .max = 4});
  v.add("rests_on_ground", rests_on_ground, {.doc = "the object stands on the floor"});
  v.add("landmark", landmark, {.doc = "false: seen and masked out, never mapped"});
  v.add("color", color, {.doc = "colour in pictures, #rrggbb"});
}

ObjectShape ObjectModel::nominal() const {
  return {shapeKindFromString(shape), width_m, depth_m, height_m};
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
    ObjectModel model;
    schema.add(entry.section, model);
    config.read(entry.section, model);
    model.class_name = entry.section;
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

std::string ObjectDatabase::markdown() {
  ObjectModel model;
  ConfigSchema schema;
  schema.add("class name", model);
  return schema.markdown();
}

}  // namespace roomgraph
