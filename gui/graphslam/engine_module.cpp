// SPDX-License-Identifier: BSD-3-Clause
// The one translation unit with MRPT's graph-SLAM engine, for planar and for spatial networks.
#include <mrpt/graphslam/CGraphSlamEngine.h>
// The engine's header goes first: the others do not compile without it.
#include <mrpt/config/CConfigFile.h>
#include <mrpt/graphslam/ERD/CEmptyERD.h>
#include <mrpt/graphslam/ERD/CICPCriteriaERD.h>
#include <mrpt/graphslam/ERD/CLoopCloserERD.h>
#include <mrpt/graphslam/GSO/CLevMarqGSO.h>
#include <mrpt/graphslam/NRD/CEmptyNRD.h>
#include <mrpt/graphslam/NRD/CFixedIntervalsNRD.h>
#include <mrpt/graphslam/NRD/CICPCriteriaNRD.h>

#include "engine_session.h"
#include "roomgraph/evaluation/trajectory_file.h"

namespace roomgraph {
namespace {

// The engine wants the four columns of MRPT's simulator, and would read anything.
void checkTruth(const EngineRequest& request, const EngineIni& ini) {
  if (request.truth.empty()) return;
  if (ini.parts.dimensions == 3) throw ConfigError("--truth: the engine reads it for planar poses alone");
  if (!readTrajectory(request.truth).planar)
    throw InputError(request.truth.string() + ": is not in the format 't x y phi' of MRPT's simulator");
}

/// A session whose making and end are quiet: MRPT prints before anybody can tell it not to.
template <class GRAPH>
class QuietSession {
 public:
  QuietSession(const EngineRequest& request, const EngineIni& ini) : quiet_(!request.verbose) {
    const QuietConsole quiet(quiet_);
    session_ = std::make_unique<EngineSession<GRAPH>>(request, ini);
  }
  ~QuietSession() {
    const QuietConsole quiet(quiet_);
    session_.reset();
  }
  EngineOutcome run() { return session_->run(); }

 private:
  bool quiet_;
  std::unique_ptr<EngineSession<GRAPH>> session_;
};

template <class GRAPH>
EngineOutcome runOn(const EngineRequest& request, const EngineIni& ini) {
  return QuietSession<GRAPH>(request, ini).run();
}

}  // namespace
}  // namespace roomgraph

extern "C" __attribute__((visibility("default"))) roomgraph::EngineOutcome roomgraph_run_engine(
    const roomgraph::EngineRequest& request) {
  using namespace roomgraph;
  const EngineIni ini = readEngineIni(request.ini, request.asked);
  checkTruth(request, ini);
  return ini.parts.dimensions == 3 ? runOn<SemanticNetwork3D>(request, ini) : runOn<SemanticNetwork2D>(request, ini);
}
