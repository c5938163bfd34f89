// SPDX-License-Identifier: BSD-3-Clause
// One run of an engine over a recording: steps, results, errors.
#pragma once

#include <iostream>
#include <sstream>

#include "engine_parts.h"
#include "engine_window.h"
#include "path_record.h"
#include "roomgraph/core/error_text.h"
#include "roomgraph/core/output_folder.h"
#include "roomgraph/datasets/rawlog_objects.h"
#include "roomgraph/graphslam/engine_files.h"

namespace roomgraph {

/// What the engine and its deciders print goes nowhere meanwhile; their report files have it.
class QuietConsole {
 public:
  enum class Streams { kBoth, kOut };
  explicit QuietConsole(bool quiet, Streams streams = Streams::kBoth)
      : quiet_(quiet), out_(std::cout.rdbuf()), err_(std::cerr.rdbuf()) {
    if (!quiet_) return;
    std::cout.rdbuf(&nothing_);
    if (streams == Streams::kBoth) std::cerr.rdbuf(&nothing_);
  }
  ~QuietConsole() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(err_);
  }

 private:
  struct Nothing : std::streambuf {
    int overflow(int c) override { return traits_type::not_eof(c); }
  } nothing_;
  bool quiet_;
  std::streambuf *out_, *err_;
};

template <class GRAPH>
class EngineSession {
 public:
  /// Throws like RunEngine.
  EngineSession(const EngineRequest& request, const EngineIni& ini)
      : request_(request),
        ini_(ini),
        recording_(request.rawlog),
        files_(request.output, engineFileNames(ini), inputsOf(request)) {
    outcome_.parts = ini.parts;
    if (ini.parts.anyOfOurs())
      front_end_ = std::make_unique<EngineFrontEnd>(request.make_setup(), request.rawlog);
    if (ini.parts.has("CObjectClosuresERD")) front_end_->mapObjects(request.make_setup());
    if (request.window) window_ = std::make_unique<EngineWindow>("roomgraph graphslam: " + request.rawlog.filename().string());
    const SceneLock lock(request.truth.empty() ? display() : nullptr);  // with a truth the engine may wait for a second window
    try {
      parts_ = PartMaker<GRAPH>(front_end_.get()).make(ini.parts);
      setConsole();
      engine_ = std::make_unique<HostedEngine<GRAPH>>(request.ini.string(), request.rawlog.string(),
                                                      request.truth.string(),
                                                      window_ ? window_->manager() : nullptr, parts_);
      engine_->logging_enable_console_output = request.verbose;
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {
      throw ConfigError("--ini " + request.ini.string() + ": " + firstLine(error));
    }
  }

  EngineOutcome run() {
    const QuietConsole quiet(!request_.verbose, QuietConsole::Streams::kOut);  // the window prints its events
    bool goes_on = true;
    while (goes_on && !(outcome_.interrupted = request_.interrupted())) {
      const auto object = recording_.next();
      if (!object) break;
      goes_on = waitWhilePaused() && take(object);
      request_.progress(outcome_.share = recording_.progress());
    }
    if (!goes_on) outcome_.interrupted = true;  // Ctrl-C in the window
    if (!outcome_.interrupted) outcome_.share = 1;
    {
      const SceneLock lock(display());
      engine_->finish(front_end_.get());
    }
    conclude();
    return outcome_;
  }

 private:
  static constexpr mrpt::graphs::TNodeID kNearNodes = 10;  // edges of local maps are no loop closures

  static std::vector<std::filesystem::path> inputsOf(const EngineRequest& request) {
    std::vector<std::filesystem::path> inputs{request.rawlog, request.ini};
    if (!request.truth.empty()) inputs.push_back(request.truth);
    return inputs;
  }

  void setConsole() {
    for (mrpt::system::COutputLogger* logger :
         {static_cast<mrpt::system::COutputLogger*>(parts_.node.get()),
          static_cast<mrpt::system::COutputLogger*>(parts_.edge.get()),
          static_cast<mrpt::system::COutputLogger*>(parts_.optimizer.get())})
      logger->logging_enable_console_output = request_.verbose;
  }

  // An action waits for its sensory frame.
  bool take(const mrpt::serialization::CSerializable::Ptr& object) {
    ActionPtr action;
    SensoryFramePtr observations;
    ObservationPtr observation;
    if (const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) {
      waiting_ = actions;
      return true;
    }
    if ((observations = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))) {
      if (!waiting_) {
        ++frames_without_action_;
        return true;
      }
      action = std::exchange(waiting_, nullptr);
    } else if (!(observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))) {
      return true;
    }
    return step(action, observations, observation);
  }

  mrpt::gui::CDisplayWindow3D* display() { return window_ ? window_->display() : nullptr; }

  // False when the end is asked for meanwhile.
  bool waitWhilePaused() {
    bool goes_on = true;
    if (window_)
      window_->waitWhilePaused([&] {
        const SceneLock lock(display());
        return goes_on = engine_->answerKeys() && !request_.interrupted();
      });
    return goes_on;
  }

  bool step(ActionPtr& action, SensoryFramePtr& observations, ObservationPtr& observation) {
    const SceneLock lock(display());
    bool goes_on = true;
    std::size_t entry = static_cast<std::size_t>(outcome_.records);
    try {
      goes_on = engine_->_execGraphSlamStep(action, observations, observation, entry);
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {
      throw RunError(request_.rawlog.string() + ": record " + std::to_string(outcome_.records) + ": the engine failed: " +
                     firstLine(error));
    }
    ++outcome_.records;
    notePose(timeOfStep(observations, observation));
    return goes_on;
  }

  // Our node decider is as far as its front ends; all others as far as the engine.
  void notePose(double t) {
    if (ini_.parts.has("CKeyPosesNRD")) {
      if (!front_end_->now()) return;
      t = *front_end_->now();
    }
    path_.add(t, engine_->getGraph(), poseOf(engine_->getCurrentRobotPosEstimation()));
  }

  void conclude() {
    const GRAPH& graph = engine_->getGraph();
    outcome_.nodes = static_cast<int>(graph.nodes.size());
    for (const auto& [ends, edge] : graph.edges) {
      const auto apart = ends.first < ends.second ? ends.second - ends.first : ends.first - ends.second;
      ++outcome_.edges;
      outcome_.closures += apart > kNearNodes;
    }
    warn();
    if (outcome_.nodes == 0) {
      if (outcome_.interrupted) throw Interrupted("interrupted before there was a node; nothing was written");
      throw RunError(request_.rawlog.string() + ": " + ini_.parts.node +
                     " registered no node; 'roomgraph info' tells what is inside");
    }
    write();
  }

  void warn() {
    auto& warnings = outcome_.warnings;
    if (!recording_.truncation().empty()) warnings.push_back(recording_.truncation());
    for (const auto& [reason, count] : recording_.skipped())
      warnings.push_back(std::to_string(count) + " records left out: " + reason);
    if (frames_without_action_ > 0)
      warnings.push_back(std::to_string(frames_without_action_) + " sensory frames without an action before them left out");
    if (engine_->truthEnded()) warnings.push_back(request_.truth.string() + ": ends before the recording");
    if (front_end_ && front_end_->counts().disordered > 0)
      warnings.push_back(std::to_string(front_end_->counts().disordered) + " records left out whose stamps do not come after those before: was the clock set back? "
                         "'roomgraph info' tells, and 'roomgraph run' goes on after it");
    if (front_end_)
      for (const auto& warning : front_end_->statistics().sensor_warnings) warnings.push_back(warning);
  }

  void write() {
    OutputFolder& files = files_;
    const auto folder = files.pending("summary.json").parent_path();
    const GRAPH& graph = engine_->getGraph();
    engine_->generateReportFiles(folder.string());
    if (ini_.save_graph) graph.saveToTextFile(files.pending(ini_.graph_file).string());
    if (ini_.save_map) writeMap(files);
    writeTrajectory(files.pending("trajectory.tum"), path_.poses(graph));
    if (ini_.parts.has("CObjectClosuresERD"))
      writeObjects(files.pending("landmarks.json"), objectsIn(graph, front_end_->confirmedLandmarks()));
    if (window_) showAndSave(files);
    {
      const QuietConsole quiet(!request_.verbose);
      engine_.reset();  // closes its report files, and prints how long it took
    }
    writeEngineSummary(files.pending("summary.json"), request_, outcome_);
    files.publish();
  }

  void writeMap(OutputFolder& files) {
    if constexpr (kPlanar<GRAPH>) {
      const auto map = engine_->map();
      if (!map) return outcome_.warnings.push_back("no map: no node has a scan");
      map->saveMetricMapRepresentationToFile(files.pending(ini_.map_file + ".png").replace_extension().string());
    }
  }

  void showAndSave(OutputFolder& files) {
    if (!outcome_.interrupted) window_->wait(request_.exit_after_s, request_.interrupted);
    const std::string scene = files.pending(ini_.scene_file).string();
    if (ini_.save_scene) engine_->save3DScene(&scene);
  }

  const EngineRequest& request_;
  const EngineIni& ini_;
  RawlogObjects recording_;
  OutputFolder files_;  ///< made first: that it cannot be written is no news for the end
  std::unique_ptr<EngineFrontEnd> front_end_;
  std::unique_ptr<EngineWindow> window_;
  OwnedParts<GRAPH> parts_;
  std::unique_ptr<HostedEngine<GRAPH>> engine_;
  PathRecord<GRAPH> path_;
  EngineOutcome outcome_;
  ActionPtr waiting_;
  int frames_without_action_ = 0;
};

}  // namespace roomgraph
