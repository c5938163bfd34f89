// SPDX-License-Identifier: BSD-3-Clause
// `roomgraph run` that records detections: replay gives the same map; debug pictures.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "data_folder.h"
#include "program.h"
#include "rawlog_maker.h"
#include "roomgraph/datasets/rawlog_reader.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kRoomToRecord = fs::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rawlog";

fs::path modelFolder() {
  return dataFolder() / "models";
}

/// Detections in a rawlog, by time.
std::map<double, CObservationDetections> detectionsIn(const fs::path& rawlog) {
  std::map<double, CObservationDetections> out;
  RawlogReader reader(rawlog);
  while (const auto record = reader.next())
    if (const auto* detections = std::get_if<std::shared_ptr<CObservationDetections>>(&*record)) {
      EXPECT_TRUE(out.emplace(timeOf(*record), **detections).second) << "two records at one time";
    }
  EXPECT_EQ(reader.statistics().warning, "");
  return out;
}

void writeWithoutDetections(const fs::path& file) {
  mrpt::io::CFileGZInputStream stream(kRoomToRecord.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  std::vector<test::Object> kept;
  try {
    while (true)
      if (const auto object = archive.ReadObject();
          !std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object))
        kept.push_back(object);
  } catch (const mrpt::serialization::CExceptionEOF&) {
    // The end of the recording.
  }
  EXPECT_GT(kept.size(), 150u);
  test::writeRawlog(file, kept);
}

class RecordingTest : public ::testing::Test {
 protected:
  CallResult run(const fs::path& input, const std::string& output, std::vector<std::string> more) {
    more.insert(more.begin(),
                {"run", input.string(), "-o", folder.file(output).string(), "--quiet", "--no-snapshot"});
    return call(folder.path(), more);
  }
  // The header of landmarks.json names the recording.
  static std::string withoutHeader(const fs::path& file) {
    const std::string text = contentOf(file);
    return file.filename() == "landmarks.json" ? text.substr(text.find("\"landmarks\"")) : text;
  }
  // Both runs found the same, and not only that there is nothing.
  void expectSameRun(const std::string& a, const std::string& b, std::size_t least_landmarks) {
    const json landmarks = json::parse(contentOf(folder.file(a) / "landmarks.json")).at("landmarks");
    EXPECT_GE(landmarks.size(), least_landmarks);
    EXPECT_GT(linesOf(contentOf(folder.file(a) / "associations.jsonl")).size(), 10 * least_landmarks);
    for (const char* name : {"landmarks.json", "detections.jsonl", "trajectory.tum", "associations.jsonl"}) {
      EXPECT_FALSE(contentOf(folder.file(a) / name).empty()) << name;
      EXPECT_TRUE(withoutHeader(folder.file(a) / name) == withoutHeader(folder.file(b) / name)) << name;
    }
  }
  TemporaryFolder folder;
  std::vector<std::string> replayed{"--set", "detection.class=RecordedDetector"};
};

// With real networks, one of which gives masks; they run on every second frame, the others are carried.
TEST_F(RecordingTest, ReplayOfNetworksGivesTheSameMap) {
  const auto boxes = modelFolder() / "nanodet-plus-m-1.5x/nanodet-plus-m_1.5x-320.onnx";
  const auto doors = modelFolder() / "deeplabv3-mnv2-ade20k/deeplabv3_mnv2_ade20k_256x256.onnx";
  if (!fs::exists(boxes) || !fs::exists(doors)) GTEST_SKIP() << "no networks in " << modelFolder();
  const auto copy = folder.file("copy.rawlog");
  const std::string score = "detection.score_threshold=0.2";  // simulated pictures: networks are not sure
  const auto live = run(kRoomToRecord, "live",
                        {"--record-detections", copy.string(), "--set",
                         "detection.models=" + boxes.string() + "," + doors.string(), "--set", score, "--set",
                         "detection.every_nth_frame=2"});
  ASSERT_EQ(live.exit_code, 0) << live.err;
  const auto again = run(copy, "again", {"--set", "detection.class=RecordedDetector", "--set", score});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  expectSameRun("live", "again", 1);
  const auto recorded = detectionsIn(copy);
  EXPECT_EQ(recorded.size(), 21u);
  for (const auto& [t, detections] : recorded) {
    EXPECT_EQ(detections.model, "nanodet-plus-m_1.5x-320+deeplabv3_mnv2_ade20k_256x256");
    EXPECT_EQ(detections.model_hash.size(), 16u + 1 + 16);
    EXPECT_EQ(detections.image_width, 320u);
  }
  const auto strict =
      run(copy, "strict",
          {"--set", "detection.class=RecordedDetector", "--set", "detection.score_threshold=0.1"});
  EXPECT_THAT(strict.err, ::testing::HasSubstr("hold no score below 0.2"));
}

TEST_F(RecordingTest, RecordedDetectionsAreRecordedAgainAsTheyAre) {
  auto arguments = replayed;
  const auto copy = folder.file("copy.rawlog");
  arguments.insert(arguments.end(), {"--record-detections", copy.string()});
  ASSERT_EQ(run(kRoomToRecord, "first", arguments).exit_code, 0);
  ASSERT_EQ(run(copy, "second", replayed).exit_code, 0);
  expectSameRun("first", "second", 3);
  const auto before = detectionsIn(kRoomToRecord), after = detectionsIn(copy);
  EXPECT_EQ(before.size(), after.size());
  EXPECT_EQ(after.begin()->second.model, before.begin()->second.model);
}

// A calibration says that the camera's clock is late: the copy keeps the stamps of the input, of images and of boxes.
TEST_F(RecordingTest, BoxesKeepTheStampsOfTheirImagesWhateverTheCalibration) {
  const auto calibration = folder.write("calibration.ini", "[sensor KINECT]\ntime_offset_s = 0.08\n");
  auto arguments = replayed;
  const auto copy = folder.file("copy.rawlog");
  arguments.insert(arguments.end(), {"--calibration", calibration.string(), "--record-detections", copy.string()});
  const auto first = run(kRoomToRecord, "first", arguments);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const auto before = detectionsIn(kRoomToRecord), after = detectionsIn(copy);
  ASSERT_EQ(before.size(), after.size());
  for (auto a = before.begin(), b = after.begin(); a != before.end(); ++a, ++b) EXPECT_NEAR(b->first, a->first, 1e-6);
}

TEST_F(RecordingTest, WrongUseIsRefused) {
  fs::copy(kRoomToRecord, folder.file("own.rawlog"));
  auto itself = replayed;
  itself.insert(itself.end(), {"--record-detections", folder.file("own.rawlog").string()});
  expectOneLine(run(folder.file("own.rawlog"), "out", itself), 2,
                ::testing::HasSubstr("is read by this command"));
  EXPECT_EQ(fs::file_size(folder.file("own.rawlog")), fs::file_size(kRoomToRecord));
  expectOneLine(run(kRoomToRecord, "out", {"--set", "detection.enabled=false", "--record-detections", "x.rawlog"}), 2,
                ::testing::HasSubstr("needs a detector"));
  expectOneLine(run(kRoomToRecord, "out", {"--debug-images", (folder.file("own.rawlog") / "x").string()}), 1,
                ::testing::HasSubstr("debug pictures"));
}

TEST_F(RecordingTest, AnInterruptedRunLeavesTheWholeInput) {
  const auto copy = folder.file("copy.rawlog"), out = folder.file("out"), pictures = folder.file("pictures");
  std::vector<std::string> arguments{
      "run",           kRoomToRecord.string(), "-o",          out.string(),     "--quiet",
      "--no-snapshot", "--record-detections",  copy.string(), "--debug-images", pictures.string()};
  arguments.insert(arguments.end(), replayed.begin(), replayed.end());
  Program program(folder.path(), arguments);
  // The first picture says that there is a pose.
  for (int i = 0; i < 12000 && (!fs::exists(pictures) || fs::is_empty(pictures)); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(program.pid(), SIGINT);
  EXPECT_EQ(program.wait().exit_code, 4);
  int frames = 0, original = 0;
  for (const auto& [file, count] : {std::pair{copy, &frames}, {kRoomToRecord, &original}}) {
    RawlogReader reader(file);
    while (const auto record = reader.next()) *count += std::holds_alternative<Frame>(*record);
    EXPECT_EQ(reader.statistics().warning, "");
  }
  EXPECT_GT(original, 0);
  EXPECT_EQ(frames, original);
}

// A record on every third frame only: the others are carried, and marked.
TEST_F(RecordingTest, SparseRecordsAreCarried) {
  ASSERT_EQ(run(kRoomToRecord, "all", replayed).exit_code, 0);
  const auto lines = linesOf(contentOf(folder.file("all") / "detections.jsonl"));
  ASSERT_GT(lines.size(), 20u);
  std::string sparse;
  for (std::size_t i = 0; i < lines.size(); i += 3) sparse += lines[i] + "\n";
  const auto file = folder.write("sparse.jsonl", sparse).string();
  const auto count = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--set", "detection.class=RecordedDetector", "--set",
                                       "detection.file=" + file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(folder.file("bare.rawlog"), output, arguments).exit_code, 0);
    int carried = 0, detected = 0;
    for (const auto& line : linesOf(contentOf(folder.file(output) / "detections.jsonl"))) {
      const json frame = json::parse(line);
      for (const auto& box : frame.at("boxes")) ++(box.value("carried", false) ? carried : detected);
    }
    return std::pair{detected, carried};
  };
  writeWithoutDetections(folder.file("bare.rawlog"));
  const auto on = count("on", {}), off = count("off", {"--set", "detection.track_boxes=false"});
  EXPECT_GT(off.first, 5);
  EXPECT_EQ(off.second, 0);
  EXPECT_EQ(on.first, off.first);
  EXPECT_GT(on.second, on.first) << "two frames of three";
}

TEST_F(RecordingTest, OneDebugPicturePerFrame) {
  auto arguments = replayed;
  arguments.insert(arguments.end(), {"--debug-images", folder.file("pictures").string()});
  ASSERT_EQ(run(kRoomToRecord, "out", arguments).exit_code, 0);
  const json summary = json::parse(contentOf(folder.file("out") / "summary.json"));
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder.file("pictures"))) {
    ++pictures;
    EXPECT_EQ(cv::imread(entry.path().string()).size(), cv::Size(320, 240)) << entry.path();
  }
  EXPECT_EQ(pictures, summary["counts"]["frames"].get<int>());
}

}  // namespace
}  // namespace roomgraph::test
