// SPDX-License-Identifier: BSD-3-Clause
// LiveReplay of a shipped recording against the same replay without a viewer; mailbox, live grid, images
// found again.
#include "roomgraph/viewer/live_replay.h"

#include <gtest/gtest.h>

#include <chrono>
#include <opencv2/core.hpp>
#include <thread>

#include "errors_of.h"
#include "live_grid.h"
#include "made_up_states.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/pipeline/read_options.h"
#include "roomgraph/viewer/frame_finder.h"
#include "roomgraph/viewer/timeline.h"

namespace roomgraph::test {
namespace {

using std::chrono::milliseconds;
using Phase = LiveReplay::Phase;

const std::filesystem::path kSource = ROOMGRAPH_SOURCE_DIR,
                            kRecording = kSource / "rawlogs" / "tiny_room.rawlog";

std::unique_ptr<Setup> tinySetup() {
  Config config = Config::fromFile(kSource / "config.ini");
  config.override("tracking.max_features=900");
  return makeSetup(config, kSource / "objects.ini");
}

std::unique_ptr<RecordStream> openTiny() {
  return std::make_unique<RawlogReader>(kRecording, readOptionsOf(tinySetup()->options));
}

template <class Condition>
bool waitFor(const Condition& condition) {
  for (int i = 0; i < 6000 && !condition(); ++i) std::this_thread::sleep_for(milliseconds(10));
  return condition();
}

/// A recording that breaks after some records.
class Breaking : public RecordStream {
 public:
  std::optional<Record> next() override {
    if (left_-- == 0) throw InputError("tiny.rawlog: the disk is gone");
    return stream_->next();
  }

 private:
  std::unique_ptr<RecordStream> stream_ = openTiny();
  int left_ = 60;
};

TEST(StateMailbox, HoldsEveryStateAndTheNewestFrame) {
  StateMailbox mailbox;
  const auto frame = std::make_shared<const SeenFrame>(), newer = std::make_shared<const SeenFrame>();
  mailbox.put(stateAt(1), frame);
  mailbox.put(stateAt(2), newer);
  mailbox.put(stateAt(3));
  EXPECT_EQ(frame.use_count(), 1) << "images do not pile up";
  const auto content = mailbox.take();
  EXPECT_EQ(content.states.size(), 3u);
  EXPECT_EQ(content.states.back()->record, 3);
  EXPECT_EQ(content.frame, newer);
  EXPECT_TRUE(mailbox.take().states.empty());
  EXPECT_EQ(mailbox.take().frame, nullptr);
}

/// A whole replay, watched by nobody until it has ended.
class WatchedReplay : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto setup = tinySetup();
    RawlogReader reader(kRecording, readOptionsOf(setup->options));
    SemanticSlam slam(tinySetup());
    replay(reader, slam);
    alone_ = std::make_unique<SlamResult>(slam.finish());
    live_ = std::make_unique<LiveReplay>(openTiny(), tinySetup());
    live_->control().setSpeed(0);
    live_->control().play(true);
    ASSERT_TRUE(waitFor([] { return live_->phase() == Phase::kEnded; }));
    content_ = live_->mailbox().take();
    ASSERT_GT(content_.states.size(), 3u);
  }
  static void TearDownTestSuite() {
    live_.reset();
    alone_.reset();
    content_ = {};
  }
  static std::unique_ptr<SlamResult> alone_;
  static std::unique_ptr<LiveReplay> live_;
  static StateMailbox::Content content_;
};
std::unique_ptr<SlamResult> WatchedReplay::alone_;
std::unique_ptr<LiveReplay> WatchedReplay::live_;
StateMailbox::Content WatchedReplay::content_;

TEST_F(WatchedReplay, EndsWithTheResultOfARunThatNobodyWatches) {
  const ViewState& last = *content_.states.back();
  EXPECT_NO_THROW(live_->rethrow());
  EXPECT_EQ(live_->share(), 1);
  std::vector<Landmark> mapped;
  for (const auto& shown : *last.landmarks)
    if (shown->in_map) mapped.push_back(shown->landmark);
  ASSERT_EQ(mapped.size(), alone_->map.landmarks.size());
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    EXPECT_EQ(mapped[i].position, alone_->map.landmarks[i].position) << "the same bits";
    EXPECT_EQ(mapped[i].existence, alone_->map.landmarks[i].existence);
    EXPECT_EQ(mapped[i].class_name, alone_->map.landmarks[i].class_name);
  }
  EXPECT_EQ(last.landmarks->size(), alone_->candidates.size());
  EXPECT_EQ(last.path->size(), alone_->world_from_robot.size());
  ASSERT_TRUE(last.grid);
  EXPECT_EQ(last.grid->getRawMap(), alone_->map.occupancy->getRawMap());
  EXPECT_FALSE((*last.landmarks)[0]->evidence.empty());
}

TEST_F(WatchedReplay, HasAStateForEveryFrameAndScan) {
  const int records = alone_->counts.frames + alone_->counts.scans;
  ASSERT_EQ(content_.states.size(), static_cast<std::size_t>(records) + 1) << "and the result";
  for (std::size_t i = 0; i < content_.states.size(); ++i)
    EXPECT_EQ(content_.states[i]->record, static_cast<int>(i) + 1);
  for (std::size_t i = 1; i + 1 < content_.states.size(); ++i)
    EXPECT_GE(content_.states[i]->t, content_.states[i - 1]->t);
}

TEST_F(WatchedReplay, TheMapGrows) {
  const ViewState &early = *content_.states[20], &late = *content_.states[content_.states.size() - 2];
  EXPECT_LE(early.landmarks->size(), late.landmarks->size());
  ASSERT_TRUE(early.key_poses && late.key_poses);
  EXPECT_LT(early.key_poses->size(), late.key_poses->size());
  EXPECT_EQ(late.key_poses->size(), static_cast<std::size_t>(alone_->counts.key_poses));
  EXPECT_FALSE(late.scan.empty());
  EXPECT_LE(late.scan.size(), 400u);
  std::size_t sightings = 0, people = 0;
  for (const auto& state : content_.states)
    sightings += state->sightings.size(), people += state->people.size();
  EXPECT_GT(sightings, 20u);
  EXPECT_GT(people, 0u) << "somebody walks through the room";
}

TEST_F(WatchedReplay, ScansLieWhereTheWallsAre) {
  const ViewState& last = *content_.states.back();
  int on_walls = 0;
  for (const auto& point : content_.states[content_.states.size() - 2]->scan) {
    float least = 1;
    for (const float dx : {-0.1f, -0.05f, 0.f, 0.05f, 0.1f})
      for (const float dy : {-0.1f, -0.05f, 0.f, 0.05f, 0.1f})
        least = std::min(least, last.grid->getPos(point.x() + dx, point.y() + dy));
    on_walls += least < 0.3f;
  }
  EXPECT_GT(on_walls, static_cast<int>(content_.states[content_.states.size() - 2]->scan.size()) * 8 / 10);
}

TEST_F(WatchedReplay, StatesShareWhatDidNotChange) {
  int paths = 0, landmarks = 0, kept = 0;
  for (std::size_t i = 1; i + 1 < content_.states.size(); ++i) {
    const ViewState &before = *content_.states[i - 1], &state = *content_.states[i];
    paths += before.key_poses != state.key_poses;
    landmarks += before.landmarks != state.landmarks;
    for (std::size_t k = 0; k < std::min(before.landmarks->size(), state.landmarks->size()); ++k)
      kept += (*before.landmarks)[k] == (*state.landmarks)[k];
  }
  EXPECT_EQ(paths, alone_->counts.key_poses - (content_.states.front()->key_poses ? 1 : 0))
      << "one for each key pose";
  EXPECT_LT(landmarks, static_cast<int>(content_.states.size()) * 9 / 10);
  EXPECT_GT(kept, 20);
}

TEST_F(WatchedReplay, StatesHoldNoImagesButTheNewestFrameDoes) {
  for (const auto& state : content_.states) {
    if (!state->frame) continue;
    EXPECT_EQ(state->frame->image, nullptr);
    for (const auto& box : state->frame->detections.boxes) EXPECT_TRUE(box.mask.empty());
    EXPECT_TRUE(!state->frame->proposals || state->frame->proposals->traces.empty());
  }
  ASSERT_TRUE(content_.frame);
  EXPECT_EQ(content_.frame->report.image, &content_.frame->frame);
  EXPECT_FALSE(content_.frame->frame.color.empty());
  EXPECT_EQ(content_.frame->report.t, content_.states.back()->frame->t);
}

TEST_F(WatchedReplay, SightingsOfAnObjectAreItsObservations) {
  Timeline timeline;
  timeline.add(content_.states);
  for (const auto& landmark : alone_->map.landmarks) {
    const auto sightings = timeline.sightingsOf(landmark.id);
    EXPECT_EQ(static_cast<int>(sightings.size()), landmark.observations) << landmark.id;
    for (const auto& sighting : sightings) {
      double sum = 0;
      for (const auto& [id, p] : sighting.posterior) sum += p;
      EXPECT_NEAR(sum, 1, 1e-6);
    }
  }
}

TEST(LiveReplay, StopsInTheMiddleWhenNobodyWatchesAnyMore) {
  LiveReplay live(openTiny(), tinySetup());
  EXPECT_TRUE(live.mailbox().take().states.empty()) << "paused";
  live.control().runTo(5);
  std::size_t states = 0;
  EXPECT_TRUE(waitFor([&] { return (states += live.mailbox().take().states.size()) >= 5; }));
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(states + live.mailbox().take().states.size(), 5u);
  EXPECT_EQ(live.phase(), Phase::kReplaying);
  EXPECT_GT(live.share(), 0);
  EXPECT_LT(live.share(), 0.5);
}

TEST(LiveReplay, AnErrorEndsItAndIsToldLater) {
  LiveReplay live(std::make_unique<Breaking>(), tinySetup());
  live.control().setSpeed(0);
  live.control().play(true);
  ASSERT_TRUE(waitFor([&] { return live.phase() == Phase::kEnded; }));
  EXPECT_EQ(messageOf<InputError>([&] { live.rethrow(); }), "tiny.rawlog: the disk is gone");
  EXPECT_GT(live.mailbox().take().states.size(), 5u) << "what came before it is there";
}

TEST(LiveGrid, IsTheGridOfItsScansAndPoses) {
  const auto stream = openTiny();
  OccupancyMapper mapper;
  LiveGrid live{OccupancyOptions{}};
  Trajectory poses;
  while (const auto record = stream->next()) {
    const auto* scan = std::get_if<Scan>(&*record);
    if (!scan) continue;
    mapper.add(*scan);
    live.add(*scan);
    poses.add(scan->t, Pose3::Identity());
  }
  EXPECT_EQ(live.newest(), nullptr);
  EXPECT_TRUE(live.due());
  live.build(poses);
  ASSERT_TRUE(waitFor([&] { return live.newest() != nullptr; }));
  EXPECT_EQ(live.newest()->getRawMap(), mapper.build(poses)->getRawMap());
  EXPECT_TRUE(waitFor([&] { return live.due(); })) << "after a while it is time again";
}

TEST(FrameFinder, FindsTheImagesOfAnyMomentInAnyOrder) {
  std::vector<std::pair<double, cv::Scalar>> frames;
  const auto stream = openTiny();
  while (const auto record = stream->next())
    if (const auto* frame = std::get_if<Frame>(&*record))
      frames.emplace_back(frame->t, cv::sum(frame->color));
  ASSERT_GT(frames.size(), 30u);
  std::atomic<int> opened{0};
  FrameFinder finder([&] {
    ++opened;
    return openTiny();
  });
  for (const std::size_t i :
       {std::size_t{3}, std::size_t{20}, std::size_t{19}, std::size_t{4}, frames.size() - 1}) {
    std::shared_ptr<const Frame> found;
    ASSERT_TRUE(waitFor([&] { return (found = finder.find(frames[i].first)) != nullptr; })) << i;
    EXPECT_EQ(found->t, frames[i].first);
    EXPECT_EQ(cv::sum(found->color), frames[i].second);
    EXPECT_TRUE(found->depth.empty()) << "nobody needs it";
  }
  EXPECT_EQ(opened, 1) << "what was read last is kept";
}

TEST(FrameFinder, WhatIsNotThereIsNotFound) {
  FrameFinder broken([]() -> std::unique_ptr<RecordStream> { throw InputError("gone"); });
  FrameFinder finder(openTiny);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(broken.find(kBegin_t), nullptr);
    EXPECT_EQ(finder.find(12.5), nullptr) << "long before the recording";
    std::this_thread::sleep_for(milliseconds(5));
  }
}

}  // namespace
}  // namespace roomgraph::test
