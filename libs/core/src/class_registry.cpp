// SPDX-License-Identifier: BSD-3-Clause
// Lookup in MRPT's class registry by interface; dlopen of plug-ins with checks of version and content.
#include "roomgraph/core/class_registry.h"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "roomgraph/core/plugin.h"
#include "roomgraph/core/suggest.h"

namespace roomgraph {
namespace {

using ClassId = const mrpt::rtti::TRuntimeClassId*;

std::string withoutNamespace(const std::string& name) {
  const auto colon = name.rfind("::");
  return colon == std::string::npos ? name : name.substr(colon + 2);
}

// Classes that objects can be made of, by name without namespace. A class may be registered more than once.
std::map<std::string, ClassId> classesByName(ClassId interface) {
  std::map<std::string, ClassId> classes;
  for (const ClassId id : mrpt::rtti::getAllRegisteredClassesChildrenOf(interface)) {
    if (!id->ptrCreateObject) continue;
    const auto [known, added] = classes.emplace(withoutNamespace(id->className), id);
    if (!added && known->second != id)
      throw ConfigError("two classes have the name '" + known->first + "': " + known->second->className + " and " +
                        id->className + "; rename one of them");
  }
  return classes;
}

std::vector<std::string> keysOf(const std::map<std::string, ClassId>& classes) {
  std::vector<std::string> names;
  for (const auto& [name, id] : classes) names.push_back(name);
  return names;
}

// All registered classes by full name.
std::map<std::string, ClassId> registeredClasses() {
  std::map<std::string, ClassId> classes;
  for (const ClassId id : mrpt::rtti::getAllRegisteredClasses()) classes.emplace(id->className, id);
  return classes;
}

bool livesIn(const std::filesystem::path& library, ClassId id) {
  Dl_info home{};
  std::error_code error;
  return dladdr(id, &home) && std::filesystem::equivalent(home.dli_fname, library, error);
}

void checkVersion(void* library, const std::string& name) {
  auto* const version =
      reinterpret_cast<PluginInterfaceVersion*>(dlsym(library, kPluginVersionSymbol));
  if (!version)
    throw ConfigError(name + ": does not say which version of the interfaces it was compiled with: it is no " +
                      "plug-in, or ROOMGRAPH_PLUGIN() is missing (roomgraph/core/plugin.h)");
  if (version() != kPluginInterfaceVersion)
    throw ConfigError(name + ": was compiled with version " + std::to_string(version()) +
                      " of the interfaces, this program has version " + std::to_string(kPluginInterfaceVersion) +
                      "; compile it again with the headers of this program");
}

}  // namespace

std::vector<std::string> implementationsOf(const mrpt::rtti::TRuntimeClassId* interface) {
  return keysOf(classesByName(interface));
}

std::shared_ptr<mrpt::rtti::CObject> createByName(const std::string& name,
                                                  const mrpt::rtti::TRuntimeClassId* interface,
                                                  const std::string& asked_by) {
  const auto classes = classesByName(interface);
  const auto found = classes.find(withoutNamespace(name));
  if (found != classes.end() && (name == found->first || name == found->second->className))
    return found->second->createObject();
  const auto known = keysOf(classes);
  throw ConfigError(asked_by + ": no class '" + name + "' that is a " +
                    withoutNamespace(interface->className) + didYouMean(name, known) +
                    "; known: " + join(known));
}

void loadPlugin(const std::string& file) {
  const std::string name = "plug-in " + file;
  mrpt::rtti::registerAllPendingClasses();
  const auto before = registeredClasses();
  // A path, as a bare name would be looked for where the system's libraries are. Never closed: objects of its classes
  // live as long as the program.
  void* const library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_LAZY);
  if (!library) throw ConfigError(name + ": " + dlerror());
  checkVersion(library, name);
  mrpt::rtti::registerAllPendingClasses();
  const auto after = registeredClasses();
  for (const auto& [class_name, id] : before)
    if (after.at(class_name) != id)
      throw ConfigError(name + ": the class " + class_name + " is registered already, by another library");
  const auto its_own = [&](const auto& entry) { return livesIn(file, entry.second); };
  if (std::none_of(after.begin(), after.end(), its_own)) throw ConfigError(name + ": registers no class");
}

}  // namespace roomgraph
