// SPDX-License-Identifier: BSD-3-Clause
// MRPT class registration of the ShapeGenerator interface, and generators by the names in an object database.
#include "roomgraph/proposals/shape_generator.h"

#include "roomgraph/core/class_registry.h"
#include "roomgraph/proposals/register_classes.h"

namespace roomgraph {

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(ShapeGenerator, Stage, roomgraph)

ShapeGenerators::ShapeGenerators(const ObjectDatabase& database, const Make& make) {
  for (const ObjectModel& model : database.models()) {
    const std::string name = model.generatorName();
    if (!by_name_.contains(name)) by_name_[name] = make(name, model.place + " generator");
  }
}

ShapeGenerators::ShapeGenerators(const ObjectDatabase& database) {
  proposals::registerClasses();
  *this = ShapeGenerators(database, [](const std::string& name, const std::string& asked_by) {
    auto generator = createStage<ShapeGenerator>(name, asked_by);
    generator->prepare();
    return generator;
  });
}

}  // namespace roomgraph
