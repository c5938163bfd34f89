// SPDX-License-Identifier: BSD-3-Clause
// Edge registration decider made of several: the engine takes one.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "engine_step.h"

namespace roomgraph {

/// Hands everything to each of its parts, in order.
template <class GRAPH>
class CCompositeERD : public mrpt::graphslam::deciders::CEdgeRegistrationDecider<GRAPH> {
 public:
  using Part = mrpt::graphslam::deciders::CEdgeRegistrationDecider<GRAPH>;
  using Base = mrpt::graphslam::CRegistrationDeciderOrOptimizer<GRAPH>;

  explicit CCompositeERD(std::vector<std::unique_ptr<Part>> parts) : parts_(std::move(parts)) {
    this->setClassName("CCompositeERD");
  }

  bool updateState(ActionPtr action, SensoryFramePtr observations, ObservationPtr observation) override {
    bool all = true;
    for (auto& part : parts_) all = part->updateState(action, observations, observation) && all;
    return all;
  }
  bool justInsertedLoopClosure() const override {
    return std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->justInsertedLoopClosure(); });
  }
  void getEdgesStats(std::map<std::string, int>* sums) const override {
    for (const auto& part : parts_) {
      std::map<std::string, int> counts;
      part->getEdgesStats(&counts);
      for (const auto& [name, count] : counts) (*sums)[name] += count;
    }
  }
  void getDescriptiveReport(std::string* report) const override {
    for (const auto& part : parts_) {
      std::string own;
      part->getDescriptiveReport(&own);
      *report += own + "\n";
    }
  }

  void setGraphPtr(GRAPH* graph) override {
    Base::setGraphPtr(graph);
    for (auto& part : parts_) part->setGraphPtr(graph);
  }
  void setCriticalSectionPtr(std::mutex* section) override {
    Base::setCriticalSectionPtr(section);
    for (auto& part : parts_) part->setCriticalSectionPtr(section);
  }
  void setWindowManagerPtr(mrpt::graphslam::CWindowManager* manager) override {
    Base::setWindowManagerPtr(manager);
    for (auto& part : parts_) part->setWindowManagerPtr(manager);
  }
  void initializeVisuals() override {
    Base::initializeVisuals();
    for (auto& part : parts_) part->initializeVisuals();
  }
  void updateVisuals() override {
    Base::updateVisuals();
    for (auto& part : parts_) part->updateVisuals();
  }
  void notifyOfWindowEvents(const std::map<std::string, bool>& events) override {
    Base::notifyOfWindowEvents(events);
    for (auto& part : parts_) part->notifyOfWindowEvents(events);
  }
  void loadParams(const std::string& file) override {
    for (auto& part : parts_) part->loadParams(file);
  }
  void printParams() const override {
    for (const auto& part : parts_) part->printParams();
  }

 private:
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace roomgraph
