// SPDX-License-Identifier: BSD-3-Clause
// Plug-ins and stages made by class name, effective configuration and configuration schema.
#include "roomgraph/pipeline/stages.h"

#include <map>

#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/detection/register_classes.h"
#include "roomgraph/lidar/register_classes.h"
#include "roomgraph/observations/register_classes.h"
#include "roomgraph/proposals/register_classes.h"
#include "roomgraph/selection/register_classes.h"
#include "roomgraph/tracking/register_classes.h"

namespace roomgraph {
namespace {

// The class of a stage when the config names none.
const std::map<std::string, std::string> kDefaultClass = {{"scan_loop_closing", "SubmapLoopCloser"},
                                                          {"proposals", "GeometricProposalGenerator"},
                                                          {"selection", "CrfSelector"},
                                                          {"association", "SoftAssociator"}};

template <class Interface>
void addImplementations(ConfigSchema& schema, const std::string& section) {
  for (const auto& name : implementationsOf(&Interface::GetRuntimeClassIdStatic()))
    schema.add(section, *createStage<Interface>(name, section), name);
}

template <class Interface>
void addChosen(ConfigSchema& schema, const std::string& section) {
  StageChoice choice{kDefaultClass.at(section)};
  schema.add(section, choice);
  addImplementations<Interface>(schema, section);
}

// Collects the effective config while objects are read.
class Loader {
 public:
  explicit Loader(const Config& config) : config_(config) {}

  void read(const std::string& section, Configurable& target) {
    config_.read(section, target);
    note(section, target);
  }

  /// The parameters of the target as they are now are effective.
  void note(const std::string& section, Configurable& target) {
    std::string& text = sectionText(section);
    for (const auto& [key, value] : currentValues(target)) text += key + " = " + value + "\n";
  }

  template <class Interface>
  std::shared_ptr<Interface> make(const std::string& section, const std::string& name) {
    auto stage = createStage<Interface>(name, "[" + section + "] class");
    read(section, *stage);
    return stage;
  }

  /// A section that holds nothing but the choice of a class, and the parameters of that class.
  template <class Interface>
  std::shared_ptr<Interface> makeChosen(const std::string& section) {
    StageChoice choice{kDefaultClass.at(section)};
    read(section, choice);
    return make<Interface>(section, choice.stage);
  }

  std::string text() const {
    std::string all;
    for (const auto& [section, lines] : sections_) all += "[" + section + "]\n" + lines + "\n";
    return all;
  }

 private:
  std::string& sectionText(const std::string& section) {
    for (auto& [name, text] : sections_)
      if (name == section) return text;
    return sections_.emplace_back(section, "").second;
  }
  const Config& config_;
  std::vector<std::pair<std::string, std::string>> sections_;
};

void makeFrontEnds(Stages& stages, Loader& loader) {
  loader.read("rgbd", stages.rgbd);
  loader.read("odometry", stages.odometry);
  loader.read("tracking", stages.tracking);
  if (stages.tracking.enabled)
    stages.rgbd_odometry = loader.make<RgbdOdometry>("tracking", stages.tracking.stage);
  loader.read("lidar", stages.lidar);
  if (stages.lidar.enabled) stages.scan_matcher = loader.make<ScanMatcher>("lidar", stages.lidar.stage);
  if (stages.lidar.enabled && stages.lidar.loop_closing)
    stages.scan_loop_closer = loader.makeChosen<ScanLoopCloser>("scan_loop_closing");
}

void makeObjectStages(Stages& stages, Loader& loader) {
  loader.read("detection", stages.detection);
  if (stages.detection.enabled) {
    const std::string& name = stages.detection.detector;
    stages.detector = loader.make<Detector>("detection", name == "auto" ? "AutoDetector" : name);
    stages.detector->setDatabase(stages.database);
  }
  stages.proposal_generator = loader.makeChosen<ProposalGenerator>("proposals");
  stages.proposal_generator->setDatabase(stages.database);
  stages.proposal_selector = loader.makeChosen<ProposalSelector>("selection");
  stages.associator = loader.makeChosen<Associator>("association");
  loader.read("landmarks", stages.landmarks);
  loader.read("object_loop_closing", stages.object_loops);
}

void prepareAll(Stages& stages) {
  for (Stage* stage : std::initializer_list<Stage*>{stages.rgbd_odometry.get(), stages.scan_matcher.get(),
                                                    stages.scan_loop_closer.get(), stages.detector.get(),
                                                    stages.proposal_generator.get(),
                                                    stages.proposal_selector.get(), stages.associator.get()})
    if (stage) stage->prepare();
}

}  // namespace

void registerAllClasses() {
  observations::registerClasses();
  detection::registerClasses();
  tracking::registerClasses();
  lidar::registerClasses();
  proposals::registerClasses();
  selection::registerClasses();
  association::registerClasses();
}

std::unique_ptr<Stages> makeStages(const Config& config, const std::filesystem::path& objects_file) {
  registerAllClasses();
  auto stages = std::make_unique<Stages>();
  GeneralOptions& general = stages->general;
  Loader loader(config);
  config.read("pipeline", general);
  for (const auto& plugin : general.plugins) loadPlugin(plugin);
  configSchema().check(config);
  const std::filesystem::path objects =
      general.objects_file.empty() ? objects_file : std::filesystem::path(general.objects_file);
  try {
    stages->objects = readTextFile(objects);
  } catch (const InputError& error) {
    throw ConfigError(std::string("[pipeline] objects_file: ") + error.what());
  }
  stages->database = ObjectDatabase::fromText(stages->objects, objects.string());
  general.objects_file = "objects.ini";
  loader.note("pipeline", general);
  makeFrontEnds(*stages, loader);
  makeObjectStages(*stages, loader);
  loader.read("backend", stages->backend);
  loader.read("mapping", stages->mapping);
  prepareAll(*stages);
  stages->effective_config = loader.text();
  return stages;
}

ConfigSchema configSchema() {
  registerAllClasses();
  ConfigSchema schema;
  GeneralOptions general;
  RgbdOptions rgbd;
  TrackingOptions tracking;
  LidarOptions lidar;
  OdometryOptions odometry;
  DetectionStageOptions detection;
  BackendOptions backend;
  LandmarkOptions landmarks;
  ObjectLoopOptions object_loops;
  OccupancyOptions mapping;
  schema.add("pipeline", general);
  schema.add("rgbd", rgbd);
  schema.add("odometry", odometry);
  schema.add("tracking", tracking);
  addImplementations<RgbdOdometry>(schema, "tracking");
  schema.add("lidar", lidar);
  addImplementations<ScanMatcher>(schema, "lidar");
  addChosen<ScanLoopCloser>(schema, "scan_loop_closing");
  schema.add("detection", detection);
  addImplementations<Detector>(schema, "detection");
  addChosen<ProposalGenerator>(schema, "proposals");
  addChosen<ProposalSelector>(schema, "selection");
  addChosen<Associator>(schema, "association");
  schema.add("landmarks", landmarks);
  schema.add("object_loop_closing", object_loops);
  schema.add("backend", backend);
  schema.add("mapping", mapping);
  return schema;
}

}  // namespace roomgraph
