// SPDX-License-Identifier: BSD-3-Clause
// Creation of registered classes by name, and loading of plug-ins.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/stage.h"

namespace roomgraph {

/// Names (without namespace) of all registered classes that implement `interface`, sorted. Throws ConfigError
/// when two classes have the same name in different namespaces, as the name in a configuration would be ambiguous.
std::vector<std::string> implementationsOf(const mrpt::rtti::TRuntimeClassId* interface);

/// Makes an object by class name, with or without namespace. Throws ConfigError that lists the known names, and
/// like implementationsOf(). `asked_by` begins the message: "[lidar] class".
std::shared_ptr<mrpt::rtti::CObject> createByName(const std::string& name,
                                                  const mrpt::rtti::TRuntimeClassId* interface,
                                                  const std::string& asked_by);

/// Typed form: createStage<ScanMatcher>("SubmapScanMatcher", "[lidar] class").
template <class Interface>
std::shared_ptr<Interface> createStage(const std::string& name, const std::string& asked_by) {
  return std::dynamic_pointer_cast<Interface>(
      createByName(name, &Interface::GetRuntimeClassIdStatic(), asked_by));
}

/// Loads a plug-in: a shared library that exports ROOMGRAPH_PLUGIN (plugin.h) and whose initialiser registers
/// classes. Loading it again does nothing. Throws ConfigError when it cannot be loaded (with the loader's
/// message), was compiled with other versions of the interfaces, registers no class, or registers one whose full
/// name is taken.
void loadPlugin(const std::string& file);

}  // namespace roomgraph
