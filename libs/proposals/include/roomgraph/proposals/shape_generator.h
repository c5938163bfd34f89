// SPDX-License-Identifier: BSD-3-Clause
// Interface of shape generators: placed shapes from the evidence about one detection.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "roomgraph/core/stage.h"
#include "roomgraph/proposals/keep_best.h"

namespace roomgraph {

/// Makes hypotheses of one detected object's place and size (method.md sec. 1.A to 1.C). Chosen for every object class
/// by the key `generator` of objects.ini; its parameters are in the section [shape_generators] of the configuration.
class ShapeGenerator : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(ShapeGenerator)
 public:
  /// Hypotheses within `limits`, best quality first (fitShape() and judge() set the quality). Called again for the same
  /// detection with another depth mask, or none, when the first fit was poor. Keeps nothing between calls.
  virtual std::vector<PlacedShape> generate(const BoxEvidence& evidence, const GeneratorLimits& limits) const = 0;
};

/// The shape generators that the classes of an object database name, one object per name.
class ShapeGenerators {
 public:
  /// Makes a generator by its class name; `asked_by` names, for messages, the file and section that ask for it.
  using Make = std::function<std::shared_ptr<ShapeGenerator>(const std::string& name, const std::string& asked_by)>;

  ShapeGenerators() = default;
  /// Throws ConfigError naming file, section and key when a class asks for a generator that does not exist.
  ShapeGenerators(const ObjectDatabase& database, const Make& make);
  /// With the parameters' defaults.
  explicit ShapeGenerators(const ObjectDatabase& database);

  bool empty() const { return by_name_.empty(); }
  /// Generator of a class of the database. Throws std::out_of_range for a class of another one.
  const ShapeGenerator& of(const ObjectModel& model) const { return *by_name_.at(model.generatorName()); }

 private:
  std::map<std::string, std::shared_ptr<ShapeGenerator>> by_name_;
};

}  // namespace roomgraph
