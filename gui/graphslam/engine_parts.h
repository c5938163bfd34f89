// SPDX-License-Identifier: BSD-3-Clause
// Parts of an engine by their names.
#pragma once

#include "closure_decider.h"
#include "composite_decider.h"
#include "factor_graph_optimizer.h"
#include "hosted_engine.h"
#include "key_pose_decider.h"
#include "object_decider.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/graphslam/decider_names.h"

namespace roomgraph {

/// An optimizer that does nothing, which MRPT's CEmptyGSO, an abstract class, cannot be.
template <class GRAPH>
class IdleGSO : public mrpt::graphslam::optimizers::CGraphSlamOptimizer<GRAPH> {
 public:
  IdleGSO() { this->initializeLoggers("CEmptyGSO"); }
  bool updateState(ActionPtr, SensoryFramePtr, ObservationPtr) override { return true; }

 protected:
  void optimizeGraph() override {}
};

/// Parts for one engine. The names have been checked; the front end is there when one of them is ours, and
/// outlives the parts.
template <class GRAPH>
class PartMaker {
 public:
  explicit PartMaker(EngineFrontEnd* front_end) : front_end_(front_end) {}

  OwnedParts<GRAPH> make(const EngineParts& names) const {
    OwnedParts<GRAPH> parts;
    parts.node = node(names.node);
    std::vector<std::unique_ptr<EdgeDecider>> edges;
    for (const auto& name : names.edges) edges.push_back(edge(name));
    if (edges.size() == 1)
      parts.edge = std::move(edges.front());
    else
      parts.edge = std::make_unique<CCompositeERD<GRAPH>>(std::move(edges));
    parts.optimizer = optimizer(names.optimizer);
    return parts;
  }

 private:
  using NodeDecider = mrpt::graphslam::deciders::CNodeRegistrationDecider<GRAPH>;
  using EdgeDecider = mrpt::graphslam::deciders::CEdgeRegistrationDecider<GRAPH>;
  using Optimizer = mrpt::graphslam::optimizers::CGraphSlamOptimizer<GRAPH>;

  std::unique_ptr<NodeDecider> node(const std::string& name) const {
    using namespace mrpt::graphslam::deciders;
    if (name == "CKeyPosesNRD") return std::make_unique<CKeyPosesNRD<GRAPH>>(*front_end_);
    if (name == "CFixedIntervalsNRD") return std::make_unique<CFixedIntervalsNRD<GRAPH>>();
    if (name == "CEmptyNRD") return std::make_unique<CEmptyNRD<GRAPH>>();
    if constexpr (kPlanar<GRAPH>)
      if (name == "CICPCriteriaNRD") return std::make_unique<CICPCriteriaNRD<GRAPH>>();
    throw ConfigError(name + ": is no node registration decider");
  }

  std::unique_ptr<EdgeDecider> edge(const std::string& name) const {
    using namespace mrpt::graphslam::deciders;
    if (name == "CScanClosuresERD")
      return std::make_unique<CClosuresERD<GRAPH>>(name, "ICP2D", *front_end_,
                                                   [](EngineFrontEnd& f) { return f.takeScanClosures(); });
    if (name == "CImageClosuresERD")
      return std::make_unique<CClosuresERD<GRAPH>>(name, "ICP3D", *front_end_,
                                                   [](EngineFrontEnd& f) { return f.takeImageClosures(); });
    if (name == "CObjectClosuresERD") return std::make_unique<CObjectClosuresERD<GRAPH>>(*front_end_);
    if (name == "CEmptyERD") return std::make_unique<CEmptyERD<GRAPH>>();
    if constexpr (kPlanar<GRAPH>) {
      if (name == "CICPCriteriaERD") return std::make_unique<CICPCriteriaERD<GRAPH>>();
      if (name == "CLoopCloserERD") return std::make_unique<CLoopCloserERD<GRAPH>>();
    }
    throw ConfigError(name + ": is no edge registration decider");
  }

  std::unique_ptr<Optimizer> optimizer(const std::string& name) const {
    if (name == "CFactorGraphGSO")
      return std::make_unique<CFactorGraphGSO<GRAPH>>(front_end_->setup().options.backend);
    if (name == "CLevMarqGSO") return std::make_unique<mrpt::graphslam::optimizers::CLevMarqGSO<GRAPH>>();
    if (name == "CEmptyGSO") return std::make_unique<IdleGSO<GRAPH>>();
    throw ConfigError(name + ": is no optimizer");
  }

  EngineFrontEnd* front_end_;
};

}  // namespace roomgraph
