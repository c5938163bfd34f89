// SPDX-License-Identifier: BSD-3-Clause
// AutoDetector: idle, replaying, and running a network.
#include "auto_detector.h"

#include <gmock/gmock.h>
#include <mrpt/core/Clock.h>

#include "errors_of.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/errors.h"
#include "results_in_memory.h"
#include "temporary_folder.h"
#include "tiny_network.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;

const ObjectDatabase& cylinderChairs() {
  static const ObjectDatabase db =
      ObjectDatabase::fromText("[swivel_chair]\nlabels = chair\nshape = cylinder\n");
  return db;
}

void prepare(Detector& detector, const std::string& ini) {
  Config::fromText("[detection]\n" + ini, "test").read("detection", detector);
  detector.setDatabase(cylinderChairs());
  detector.prepare();
}

Frame frameAt(double t) {
  Frame frame;
  frame.t = t;
  frame.sensor_label = "KINECT";
  frame.camera = {640, 480, 500, 500, 320, 240, {}};
  frame.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar(90, 120, 150));
  return frame;
}

CObservationDetections boxesAt(double t, double score = 0.9, const std::string& camera = "") {
  CObservationDetections out;
  out.timestamp = mrpt::Clock::fromDouble(t);
  out.image_label = camera;
  out.model = "recorded";
  out.items.push_back({"chair", score, 10, 20, 110, 220, 7});
  return out;
}

TEST(AutoDetector, WithNothingItIsIdleUntilABoxComes) {
  AutoDetector detector;
  prepare(detector, "");
  EXPECT_TRUE(detector.idle());
  EXPECT_EQ(detector.warning(), "") << "it was said before the run";
  detector.feed(boxesAt(1));
  EXPECT_FALSE(detector.idle());
  const auto found = detector.detect(frameAt(1));
  ASSERT_TRUE(found) << found.reason();
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ((*found)[0].class_name, "swivel_chair");
  EXPECT_EQ(detector.identity().model, "recorded");
}

TEST(AutoDetector, ReplaysLikeTheClassThatIsNamed) {
  const std::string settings = "score_threshold = 0.5\ntolerance_s = 0.1\n";
  AutoDetector automatic;
  RecordedDetector recorded;
  prepare(automatic, settings);
  prepare(recorded, settings);
  for (Detector* detector : {static_cast<Detector*>(&automatic), static_cast<Detector*>(&recorded)}) {
    detector->feed(boxesAt(1, 0.45));
    detector->feed(boxesAt(2, 0.55));
    EXPECT_TRUE(detector->detect(frameAt(1))->empty()) << "below the threshold";
    EXPECT_EQ(detector->detect(frameAt(2.09))->size(), 1u);
    EXPECT_FALSE(detector->detect(frameAt(2.2)));
    EXPECT_EQ(detector->identity().score_threshold, 0.5);
  }
}

TEST(AutoDetector, BoxesOfAFile) {
  TemporaryFolder folder;
  const auto file = folder.write(
      "boxes.jsonl",
      R"({"timestamp": 1, "boxes": [{"class": "chair", "score": 0.9, "bbox": [1, 2, 30, 40]}]})");
  AutoDetector detector;
  prepare(detector, "file = " + file.string());
  EXPECT_FALSE(detector.idle());
  EXPECT_EQ(detector.detect(frameAt(1))->size(), 1u);
  EXPECT_THAT(messageOf<InputError>([&] { prepare(detector, "file = /nowhere/x.jsonl"); }),
              HasSubstr("/nowhere/x.jsonl"));
}

TEST(AutoDetector, ANamedNetworkIsWhatRuns) {
  TemporaryFolder folder;
  const std::string network = writeTinyNetwork(folder, 80).string();
  AutoDetector detector;
  prepare(detector, "models = " + network);
  EXPECT_FALSE(detector.idle());
  detector.feed(boxesAt(1));
  const auto found = detector.detect(frameAt(1));
  ASSERT_TRUE(found) << found.reason();
  EXPECT_TRUE(found->empty()) << "not the recorded box: this network finds nothing";
  EXPECT_EQ(detector.identity().model, "tiny");
  EXPECT_THAT(messageOf<InputError>([&] { prepare(detector, "models = /nowhere/x.onnx"); }),
              HasSubstr("/nowhere/x.onnx"));
}

// The thread that looks ahead runs the network; what it found is what detect() gives, also from the results of an earlier run.
TEST(AutoDetector, ForeseenBoxesAreThoseOfTheNetwork) {
  TemporaryFolder folder;
  AutoDetector detector, plain;
  for (AutoDetector* one : {&detector, &plain})
    prepare(*one, "models = " + writeTinyNetwork(folder, 80).string());
  ResultsInMemory results;
  detector.setResultStore(results);
  for (const double t : {1.0, 2.0}) EXPECT_TRUE(detector.foresee(frameAt(t)));
  Frame blind = frameAt(3);
  blind.color = cv::Mat();
  EXPECT_FALSE(detector.foresee(blind)) << "nothing will be found in it";
  Frame gone = frameAt(1);
  gone.color = cv::Mat();
  EXPECT_TRUE(detector.detect(gone)) << "it is not looked at again";
  for (const double t : {2.0, 4.0}) {
    const auto a = detector.detect(frameAt(t)), b = plain.detect(frameAt(t));
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->size(), b->size());
  }
  EXPECT_FALSE(detector.detect(blind));
}

TEST(AutoDetector, WithoutANetworkNothingIsForeseen) {
  AutoDetector detector;
  prepare(detector, "");
  EXPECT_FALSE(detector.foresee(frameAt(1)));
}

TEST(AutoDetector, DeclaresEveryKeyOnceAndAllOfThem) {
  AutoDetector automatic;
  DnnDetector networks;
  RecordedDetector recorded;
  std::multiset<std::string> own, wanted;
  for (const auto& [key, value] : currentValues(automatic)) own.insert(key);
  for (Configurable* part : {static_cast<Configurable*>(&networks), static_cast<Configurable*>(&recorded)})
    for (const auto& [key, value] : currentValues(*part))
      if (!wanted.contains(key)) wanted.insert(key);
  EXPECT_EQ(own, wanted);
}

TEST(RecordedDetectorWarning, SaysWhyNoBoxWasUsed) {
  const auto warningAfter = [](const std::vector<CObservationDetections>& boxes, double t) {
    RecordedDetector detector;
    prepare(detector, "score_threshold = 0.1");
    for (const auto& box : boxes) detector.feed(box);
    (void)detector.detect(frameAt(t));
    return detector.warning();
  };
  EXPECT_EQ(warningAfter({boxesAt(1)}, 1), "");
  EXPECT_EQ(warningAfter({boxesAt(1), boxesAt(500)}, 1), "") << "one that fits is enough";
  EXPECT_THAT(warningAfter({boxesAt(500), boxesAt(510)}, 1),
              ::testing::AllOf(HasSubstr("none of the 2 images"), HasSubstr("500.000 to 510.000 s"),
                               HasSubstr("1 frames (1.000 to 1.000 s"), HasSubstr("tolerance_s = 0.02")));
  EXPECT_THAT(warningAfter({boxesAt(1, 0.9, "REAR")}, 1),
              ::testing::AllOf(HasSubstr("'REAR'"), HasSubstr("'KINECT'")));
  EXPECT_THAT(warningAfter({}, 1), HasSubstr("the rawlog holds none"));
  RecordedDetector not_asked;
  prepare(not_asked, "");
  not_asked.feed(boxesAt(1));
  EXPECT_EQ(not_asked.warning(), "") << "a recording without images";
}

}  // namespace
}  // namespace roomgraph::test
