// SPDX-License-Identifier: BSD-3-Clause
// Lookup in MRPT's class registry by interface, and dlopen of plug-ins with a check for stages.
#include "roomgraph/core/class_registry.h"

#include <dlfcn.h>
#include <mrpt/system/os.h>

#include <algorithm>
#include <filesystem>

#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

std::string withoutNamespace(const std::string& name) {
  const auto colon = name.rfind("::");
  return colon == std::string::npos ? name : name.substr(colon + 2);
}

// Whether a registered stage lives in this shared library.
bool holdsStage(const std::filesystem::path& library) {
  const auto stages = mrpt::rtti::getAllRegisteredClassesChildrenOf(CLASS_ID(Stage));
  return std::any_of(stages.begin(), stages.end(), [&](const mrpt::rtti::TRuntimeClassId* id) {
    Dl_info home{};
    std::error_code error;
    return dladdr(id, &home) && std::filesystem::equivalent(home.dli_fname, library, error);
  });
}

}  // namespace

std::vector<std::string> implementationsOf(const mrpt::rtti::TRuntimeClassId* interface) {
  std::vector<std::string> names;
  for (const auto* id : mrpt::rtti::getAllRegisteredClassesChildrenOf(interface))
    if (id->ptrCreateObject) names.push_back(withoutNamespace(id->className));
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::shared_ptr<mrpt::rtti::CObject> createByName(const std::string& name,
                                                  const mrpt::rtti::TRuntimeClassId* interface,
                                                  const std::string& asked_by) {
  for (const auto* id : mrpt::rtti::getAllRegisteredClassesChildrenOf(interface)) {
    const bool matches = name == id->className || name == withoutNamespace(id->className);
    if (matches && id->ptrCreateObject) return id->createObject();
  }
  const auto known = implementationsOf(interface);
  throw ConfigError(asked_by + ": no class '" + name + "' that is a " +
                    withoutNamespace(interface->className) + didYouMean(name, known) +
                    "; known: " + join(known));
}

void loadPlugin(const std::string& file) {
  std::string error;
  if (!mrpt::system::loadPluginModule(file, error)) throw ConfigError("plug-in " + file + ": " + error);
  mrpt::rtti::registerAllPendingClasses();
  if (!holdsStage(file))
    throw ConfigError("plug-in " + file + ": is a shared library, but registers no stage");
}

}  // namespace roomgraph
