// SPDX-License-Identifier: BSD-3-Clause
// Creation of registered stages by class name, and loading of plug-ins.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/stage.h"

namespace roomgraph {

/// Names (without namespace) of all registered classes that implement `interface`, sorted.
std::vector<std::string> implementationsOf(const mrpt::rtti::TRuntimeClassId* interface);

/// Makes an object by class name. Throws ConfigError that lists the known names.
std::shared_ptr<mrpt::rtti::CObject> createByName(const std::string& name,
                                                  const mrpt::rtti::TRuntimeClassId* interface,
                                                  const std::string& asked_by);

/// Typed form: createStage<ScanMatcher>("CorrelativeScanMatcher", "[lidar] class").
template <class Interface>
std::shared_ptr<Interface> createStage(const std::string& name, const std::string& asked_by) {
  return std::dynamic_pointer_cast<Interface>(
      createByName(name, &Interface::GetRuntimeClassIdStatic(), asked_by));
}

/// Loads a shared library whose initialiser registers stages. Throws ConfigError with the loader's message,
/// or when there is no stage in it.
void loadPlugin(const std::string& file);

}  // namespace roomgraph
