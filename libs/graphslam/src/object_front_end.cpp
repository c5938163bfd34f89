// SPDX-License-Identifier: BSD-3-Clause
// A run with loop closing by objects alone, and what it saw of them.
#include "object_front_end.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roomgraph {

/// Confirms what objects propose, and proposes nothing.
class ConfirmingCloser : public ScanLoopCloser {
  DEFINE_MRPT_OBJECT(ConfirmingCloser, roomgraph)
 public:
  ConfirmingCloser() = default;
  explicit ConfirmingCloser(std::shared_ptr<ScanLoopCloser> closer) : closer_(std::move(closer)) {}
  void declareParameters(ParameterVisitor& v) override { closer_->declareParameters(v); }
  void setResultStore(ResultStore& store) override { closer_->setResultStore(store); }
  void add(const Scan& scan, const ScanMatch& match) override { closer_->add(scan, match); }
  std::vector<RelativePose> search(const PoseAt&) override { return {}; }
  std::optional<RelativePose> verify(const RelativePose& proposed) override { return closer_->verify(proposed); }

 private:
  std::shared_ptr<ScanLoopCloser> closer_;
};

IMPLEMENTS_MRPT_OBJECT(ConfirmingCloser, ScanLoopCloser, roomgraph)

namespace {

std::unique_ptr<Setup> closingByObjects(std::unique_ptr<Setup> setup) {
  setup->options.tracking.loop_closing = false;
  if (auto& closer = setup->stages.scan_loop_closer) closer = std::make_shared<ConfirmingCloser>(closer);
  return setup;
}

constexpr double kLeastSigma_m = 0.02;

SeenObject toSeen(const ObjectDecision& decision, const Pose3& world_from_robot, const ObjectDatabase& database) {
  const Proposal& proposal = decision.seen.measurement.proposal;
  const ObjectModel* model = database.find(proposal.class_name);
  const Eigen::Matrix2d covariance = proposal.covariance.topLeftCorner<2, 2>();
  const double variance = covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
  return {decision.landmark,
          proposal.class_name,
          world_from_robot.inverse() * decision.seen.world_from_object,
          {proposal.shape.width, proposal.shape.depth, proposal.shape.height},
          std::sqrt(std::max(variance, kLeastSigma_m * kLeastSigma_m)),
          proposal.has_yaw && model ? model->symmetry : 0};
}

}  // namespace

/// Decisions of the frames since the last call.
class ObjectFrontEnd::Sightings : public Sink {
 public:
  explicit Sightings(const ObjectDatabase& database) : database_(database) {}
  void onStep(const StepReport& report) override {
    for (const auto& decision : report.decisions)
      if (decision.landmark.valid()) seen.emplace_back(report.t, toSeen(decision, report.world_from_robot, database_));
  }
  std::vector<std::pair<double, SeenObject>> seen;

 private:
  const ObjectDatabase& database_;  // of the setup, which lives longer
};

ObjectFrontEnd::ObjectFrontEnd(std::unique_ptr<Setup> setup)
    : slam_(closingByObjects(std::move(setup))),
      sorter_(slam_.setup().options.general.lookahead_s),
      sightings_(std::make_shared<Sightings>(slam_.setup().database)) {
  slam_.addSink(sightings_);
}
ObjectFrontEnd::~ObjectFrontEnd() = default;

void ObjectFrontEnd::process(const Record& record) {
  sorter_.push(record);
  while (const auto next = sorter_.pop(false)) slam_.process(*next);
}

void ObjectFrontEnd::end() {
  while (const auto next = sorter_.pop(true)) slam_.process(*next);
}

std::vector<RelativePose> ObjectFrontEnd::takeClosures() {
  const auto& all = slam_.loopClosures();
  std::vector<RelativePose> out(all.begin() + static_cast<std::ptrdiff_t>(taken_), all.end());
  taken_ = all.size();
  return out;
}

std::vector<std::pair<double, SeenObject>> ObjectFrontEnd::takeSeen() {
  return std::exchange(sightings_->seen, {});
}

std::set<LandmarkId> ObjectFrontEnd::confirmed() const {
  std::set<LandmarkId> out;
  for (const Landmark& landmark : slam_.objects().landmarks().confirmed()) out.insert(landmark.id);
  return out;
}

}  // namespace roomgraph
