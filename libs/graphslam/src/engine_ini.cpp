// SPDX-License-Identifier: BSD-3-Clause
// General section of the engine's ini, and checks of what it names.
#include "roomgraph/graphslam/engine_ini.h"

#include <mrpt/config/CConfigFile.h>

#include "roomgraph/core/error_text.h"
#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

constexpr const char* kGeneral = "GeneralConfiguration";

bool readFlag(const mrpt::config::CConfigFile& ini, const std::string& file, const char* key, bool fallback) {
  const std::string text = ini.read_string(kGeneral, key, fallback ? "true" : "false");
  for (const char* yes : {"true", "1", "yes", "TRUE", "True"})
    if (text == yes) return true;
  for (const char* no : {"false", "0", "no", "FALSE", "False"})
    if (text == no) return false;
  throw ConfigError(file + ": [" + kGeneral + "] " + key + " = " + text + ": must be true or false");
}

// All results go into one folder.
std::string readFileName(const mrpt::config::CConfigFile& ini, const std::string& file, const char* key,
                         const std::string& fallback) {
  const std::string name = ini.read_string(kGeneral, key, fallback);
  const std::filesystem::path path = name;
  if (name.empty() || path.filename() != path || name == "." || name == "..")
    throw ConfigError(file + ": [" + kGeneral + "] " + key + " = " + name + ": must be a file name without a folder");
  return name;
}

EngineIni read(const mrpt::config::CConfigFile& ini, const std::string& file, const AskedParts& asked) {
  EngineIni out;
  EngineParts& parts = out.parts;
  const auto choose = [&](const std::string& said, const char* key, const std::string& fallback) {
    return said.empty() ? ini.read_string(kGeneral, key, fallback) : said;
  };
  parts.node = choose(asked.node, "node_registration_decider", parts.node);
  parts.edges = splitEdgeDeciders(choose(asked.edges, "edge_registration_decider", parts.edges.front()));
  parts.optimizer = choose(asked.optimizer, "optimizer", parts.optimizer);
  parts.dimensions = asked.dimensions ? asked.dimensions : ini.read_int(kGeneral, "dimensions", 2);
  out.save_graph = readFlag(ini, file, "save_graph", true);
  out.save_scene = readFlag(ini, file, "save_3DScene", true);
  out.save_map = readFlag(ini, file, "save_map", true);
  out.graph_file = readFileName(ini, file, "save_graph_fname", out.graph_file);
  out.scene_file = readFileName(ini, file, "save_3DScene_fname", out.scene_file);
  out.map_file = readFileName(ini, file, "save_map_fname", out.map_file);
  checkParts(parts, file);
  return out;
}

}  // namespace

EngineIni readEngineIni(const std::filesystem::path& file, const AskedParts& asked) {
  if (!std::filesystem::is_regular_file(file)) throw ConfigError("--ini " + file.string() + ": no such file");
  try {
    return read(mrpt::config::CConfigFile(file.string()), file.string(), asked);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw ConfigError("--ini " + file.string() + ": " + firstLine(error));
  }
}

}  // namespace roomgraph
