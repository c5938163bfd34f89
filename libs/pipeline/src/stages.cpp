// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/pipeline/stages.h"

#include "roomgraph/association/register_classes.h"
#include "roomgraph/core/class_registry.h"
#include "roomgraph/detection/register_classes.h"
#include "roomgraph/lidar/register_classes.h"
#include "roomgraph/observations/register_classes.h"
#include "roomgraph/proposals/register_classes.h"
#include "roomgraph/selection/register_classes.h"
#include "roomgraph/tracking/register_classes.h"

namespace roomgraph {
namespace {

template <class Interface>
void addImplementations(ConfigSchema& schema, const std::string& section) {
  for (const auto& name : implementationsOf(&Interface::GetRuntimeClassIdStatic()))
    schema.add(section, *createStage<Interface>(name, section), name);
}

// Collects the effective config while objects are read.
class Loader {
 public:
  explicit Loader(const Config& config) : config_(config) {}

  void read(const std::string& section, Configurable& target) {
    config_.read(section, target);
    std::string& text = sectionText(section);
    for (const auto& [key, value] : currentValues(target)) text += key + " = " + value + "\n";
  }

  template <class Interface>
  std::shared_ptr<Interface> make(const std::string& section, const std::string& name, const std::string& key = "class") {
    auto stage = createStage<Interface>(name, "[" + section + "] " + key);
    read(section, *stage);
    return stage;
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
  loader.read("odometry", stages.odometry);
  loader.read("tracking", stages.tracking);
  if (stages.tracking.enabled)
    stages.rgbd_odometry = loader.make<RgbdOdometry>("tracking", stages.tracking.stage);
  loader.read("lidar", stages.lidar);
  if (stages.lidar.enabled) stages.scan_matcher = loader.make<ScanMatcher>("lidar", stages.lidar.stage);
  if (stages.lidar.enabled && stages.lidar.loop_closing)
    stages.scan_loop_closer = loader.make<ScanLoopCloser>("lidar", stages.lidar.loop_closer, "loop_closer");
}

void makeObjectStages(Stages& stages, Loader& loader) {
  loader.read("detection", stages.detection);
  if (stages.detection.enabled) {
    stages.detector = loader.make<Detector>("detection", stages.detection.detector);
    stages.detector->setDatabase(stages.database);
  }
  StageChoice proposals{"GeometricProposalGenerator"}, selection{"UnarySelector"}, association{"GatedAssociator"};
  loader.read("proposals", proposals);
  stages.proposal_generator = loader.make<ProposalGenerator>("proposals", proposals.stage);
  stages.proposal_generator->setDatabase(stages.database);
  loader.read("selection", selection);
  stages.proposal_selector = loader.make<ProposalSelector>("selection", selection.stage);
  loader.read("association", association);
  stages.associator = loader.make<Associator>("association", association.stage);
  loader.read("landmarks", stages.landmarks);
}

void prepareAll(Stages& stages) {
  for (Stage* stage : std::initializer_list<Stage*>{
           stages.rgbd_odometry.get(), stages.scan_matcher.get(), stages.scan_loop_closer.get(),
           stages.detector.get(), stages.proposal_generator.get(), stages.proposal_selector.get(),
           stages.associator.get()})
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

std::unique_ptr<Stages> makeStages(const Config& config, const std::filesystem::path& folder) {
  registerAllClasses();
  auto stages = std::make_unique<Stages>();
  Loader loader(config);
  loader.read("pipeline", stages->general);
  for (const auto& plugin : stages->general.plugins)
    loadPlugin(std::filesystem::path(plugin).is_absolute() ? plugin : (folder / plugin).string());
  configSchema().check(config);
  stages->database = ObjectDatabase::fromFile(folder / stages->general.objects_file);
  makeFrontEnds(*stages, loader);
  makeObjectStages(*stages, loader);
  loader.read("backend", stages->backend);
  loader.read("mapping", stages->mapper);
  prepareAll(*stages);
  stages->effective_config = loader.text();
  return stages;
}

ConfigSchema configSchema() {
  registerAllClasses();
  ConfigSchema schema;
  GeneralOptions general;
  TrackingOptions tracking;
  LidarOptions lidar;
  OdometryOptions odometry;
  ObjectOptions detection;
  BackendOptions backend;
  LandmarkMap landmarks;
  OccupancyMapper mapper;
  schema.add("pipeline", general);
  schema.add("odometry", odometry);
  schema.add("tracking", tracking);
  addImplementations<RgbdOdometry>(schema, "tracking");
  schema.add("lidar", lidar);
  addImplementations<ScanMatcher>(schema, "lidar");
  addImplementations<ScanLoopCloser>(schema, "lidar");
  schema.add("detection", detection);
  addImplementations<Detector>(schema, "detection");
  StageChoice proposals{"GeometricProposalGenerator"}, selection{"UnarySelector"}, association{"GatedAssociator"};
  schema.add("proposals", proposals);
  addImplementations<ProposalGenerator>(schema, "proposals");
  schema.add("selection", selection);
  addImplementations<ProposalSelector>(schema, "selection");
  schema.add("association", association);
  addImplementations<Associator>(schema, "association");
  schema.add("landmarks", landmarks);
  schema.add("backend", backend);
  schema.add("mapping", mapper);
  return schema;
}

}  // namespace roomgraph
