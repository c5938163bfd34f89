// SPDX-License-Identifier: BSD-3-Clause
// Sections with their options, stages and descriptions.
#include "config_sections.h"

#include <algorithm>

namespace roomgraph {
namespace {

template <class Interface>
void addImplementations(ConfigSchema& schema, const std::string& section) {
  for (const auto& name : implementationsOf(&Interface::GetRuntimeClassIdStatic()))
    schema.add(section, *createStage<Interface>(name, section), name);
}

// A section of options only.
template <auto Member>
ConfigSection plain(const std::string& name, const std::string& doc) {
  return {name, doc,
          [name](SectionReader& reader, Setup& setup) { reader.read(name, setup.options.*Member); },
          [name](ConfigSchema& schema) {
            Options defaults;
            schema.add(name, defaults.*Member);
          }};
}

// A section that holds options with the name of a class, and the parameters of that class. `className` says which,
// "" when the stage is switched off.
template <auto Member, auto Made, class ClassName>
ConfigSection staged(const std::string& name, const std::string& doc, ClassName className) {
  using Interface = typename std::decay_t<decltype(std::declval<Stages>().*Made)>::element_type;
  return {name, doc,
          [name, className](SectionReader& reader, Setup& setup) {
            const std::string chosen = className(reader, name, setup.options);
            if (chosen.empty()) return;
            auto stage = createStage<Interface>(chosen, "[" + name + "] class");
            reader.read(name, *stage);
            setup.stages.*Made = std::move(stage);
          },
          [name](ConfigSchema& schema) {
            Options defaults;
            schema.add(name, defaults.*Member);
            addImplementations<Interface>(schema, name);
          }};
}

// A stage that can be switched off by its own section.
template <auto Member, auto Made>
ConfigSection optional(const std::string& name, const std::string& doc) {
  return staged<Member, Made>(name, doc, [](SectionReader& reader, const std::string& section, Options& options) {
    auto& own = options.*Member;
    reader.read(section, own);
    return own.enabled ? own.stage : "";
  });
}

// A stage that every run has.
template <auto Member, auto Made>
ConfigSection required(const std::string& name, const std::string& doc) {
  return staged<Member, Made>(name, doc, [](SectionReader& reader, const std::string& section, Options& options) {
    reader.read(section, options.*Member);
    return (options.*Member).stage;
  });
}

std::string scanLoopCloser(SectionReader& reader, const std::string& section, Options& options) {
  if (!options.lidar.enabled || !options.lidar.loop_closing) return "";
  reader.read(section, options.scan_loop_closing);
  return options.scan_loop_closing.stage;
}

std::string detector(SectionReader& reader, const std::string& section, Options& options) {
  reader.read(section, options.detection);
  if (!options.detection.enabled) return "";
  return options.detection.detector == "auto" ? "AutoDetector" : options.detection.detector;
}

// The generators that the classes in objects.ini name; they share one section.
ConfigSection shapeGenerators(const std::string& name, const std::string& doc) {
  return {name, doc,
          [name](SectionReader& reader, Setup& setup) {
            setup.stages.shape_generators =
                ShapeGenerators(setup.database, [&](const std::string& wanted, const std::string& asked_by) {
                  auto generator = createStage<ShapeGenerator>(wanted, asked_by);
                  reader.read(name, *generator);
                  generator->prepare();
                  return generator;
                });
          },
          [name](ConfigSchema& schema) { addImplementations<ShapeGenerator>(schema, name); }};
}

std::vector<ConfigSection> allSections() {
  using O = Options;
  using S = Stages;
  return {
      plain<&O::rgbd>("rgbd", "The RGB-D camera."),
      plain<&O::odometry>("odometry", "Wheel odometry and its noise."),
      optional<&O::tracking, &S::rgbd_odometry>("tracking",
                                                "Motion of the camera from RGB-D images, and its noise."),
      optional<&O::lidar, &S::scan_matcher>("lidar", "Motion of the robot from 2D scans, and its noise."),
      staged<&O::scan_loop_closing, &S::scan_loop_closer>(
          "scan_loop_closing", "Loop closures found by scans in earlier submaps.", scanLoopCloser),
      staged<&O::detection, &S::detector>("detection", "Detection of objects in images.", detector),
      required<&O::ground, &S::ground_detector>("ground", "Ground plane of a frame."),
      shapeGenerators(
          "shape_generators",
          "Parameters of the shape generators that the key `generator` of `objects.ini` names; the shipped "
          "ones have none."),
      required<&O::proposals, &S::proposal_generator>("proposals", "Lifting of boxes to shapes in 3D."),
      required<&O::selection, &S::proposal_selector>("selection", "Choice of one shape per detection."),
      required<&O::association, &S::associator>("association", "Assignment of measurements to landmarks."),
      plain<&O::landmarks>("landmarks", "Existence, confirmation, merging and splitting of landmarks."),
      plain<&O::existence>(
          "existence",
          "Existence of landmarks at the end of a run, from all that speaks for and against it."),
      plain<&O::object_loops>("object_loop_closing", "Loop closures found by constellations of objects."),
      plain<&O::relocalisation>("relocalisation",
                                "The place in an earlier map (`--map`), and what a map keeps for it."),
      plain<&O::backend>("backend", "Key poses, factors and optimisation of the factor graph."),
      plain<&O::mapping>("mapping", "The occupancy grid."),
  };
}

}  // namespace

void SectionReader::note(const std::string& section, Configurable& target) {
  const auto same = [&](const auto& known) { return known.first == section; };
  auto found = std::find_if(sections_.begin(), sections_.end(), same);
  if (found == sections_.end()) found = sections_.insert(found, {section, ""});
  std::string& text = found->second;
  for (const auto& [key, value] : currentValues(target))
    if (("\n" + text).find("\n" + key + " = ") == std::string::npos) text += key + " = " + value + "\n";
}

std::string SectionReader::text() const {
  std::string all;
  for (const auto& [section, lines] : sections_) all += "[" + section + "]\n" + lines + "\n";
  return all;
}

const std::vector<ConfigSection>& configSections() {
  static const std::vector<ConfigSection> sections = allSections();
  return sections;
}

}  // namespace roomgraph
