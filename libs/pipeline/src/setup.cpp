// SPDX-License-Identifier: BSD-3-Clause
// Plug-ins, object database, options and stages of a run, made from its configuration.
#include "roomgraph/pipeline/setup.h"

#include "config_sections.h"
#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/detection/register_classes.h"
#include "roomgraph/lidar/register_classes.h"
#include "roomgraph/observations/register_classes.h"
#include "roomgraph/proposals/register_classes.h"
#include "roomgraph/selection/register_classes.h"
#include "roomgraph/tracking/register_classes.h"

namespace roomgraph {
namespace {

constexpr const char* kGeneralDoc = "What concerns a run as a whole.";

void readDatabase(Setup& setup, const std::filesystem::path& default_file) {
  const std::string& named = setup.options.general.objects_file;
  const std::filesystem::path file = named.empty() ? default_file : std::filesystem::path(named);
  try {
    setup.objects = readTextFile(file);
  } catch (const InputError& error) {
    throw ConfigError(std::string("[pipeline] objects_file: ") + error.what());
  }
  setup.database = ObjectDatabase::fromText(setup.objects, file.string());
}

void prepare(const Setup& setup) {
  const Stages& stages = setup.stages;
  if (stages.detector) stages.detector->setDatabase(setup.database);
  stages.proposal_generator->setDatabase(setup.database);
  stages.proposal_generator->setShapeGenerators(stages.shape_generators);
  for (Stage* stage : allOf(stages)) stage->prepare();
}

}  // namespace

std::vector<Stage*> allOf(const Stages& stages) {
  std::vector<Stage*> all{stages.rgbd_odometry.get(),     stages.scan_matcher.get(),
                          stages.scan_loop_closer.get(),  stages.detector.get(),
                          stages.ground_detector.get(),   stages.proposal_generator.get(),
                          stages.proposal_selector.get(), stages.associator.get()};
  std::erase(all, nullptr);
  return all;
}

void registerAllClasses() {
  observations::registerClasses();
  detection::registerClasses();
  tracking::registerClasses();
  lidar::registerClasses();
  proposals::registerClasses();
  selection::registerClasses();
  association::registerClasses();
}

std::unique_ptr<Setup> makeSetup(const Config& config, const std::filesystem::path& objects_file) {
  registerAllClasses();
  auto setup = std::make_unique<Setup>();
  GeneralOptions& general = setup->options.general;
  config.read("pipeline", general);
  for (const auto& plugin : general.plugins) loadPlugin(plugin);
  configSchema().check(config);
  readDatabase(*setup, objects_file);
  general.objects_file = "objects.ini";
  SectionReader reader(config);
  reader.note("pipeline", general);
  for (const auto& section : configSections()) section.load(reader, *setup);
  prepare(*setup);
  setup->effective_config = reader.text();
  return setup;
}

ConfigSchema configSchema() {
  registerAllClasses();
  ConfigSchema schema;
  GeneralOptions general;
  schema.add("pipeline", general);
  schema.describe("pipeline", kGeneralDoc);
  for (const auto& section : configSections()) {
    section.describe(schema);
    schema.describe(section.name, section.doc);
  }
  return schema;
}

}  // namespace roomgraph
