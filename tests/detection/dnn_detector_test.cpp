// SPDX-License-Identifier: BSD-3-Clause
// DnnDetector: errors about model files, and published networks on real images.
#include "dnn_detector.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "roomgraph/core/class_registry.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/detection/register_classes.h"
#include "tiny_onnx.h"

namespace roomgraph {

/// Finds the same door in every image, and counts them.
class CountingDecoder : public NetworkDecoder {
  DEFINE_MRPT_OBJECT(CountingDecoder, roomgraph)
 public:
  static inline int runs = 0;
  std::string name() const override { return "counting"; }
  Preprocessing preprocessing() const override { return {}; }
  bool recognises(const NetworkOutputs&, int) const override { return true; }
  std::vector<RawBox> decode(const NetworkOutputs&, const DecodingTask&) const override {
    ++runs;
    return {{.box = {1, 1, 20, 30}, .class_index = 0, .score = 0.9}};
  }
};
IMPLEMENTS_MRPT_OBJECT(CountingDecoder, NetworkDecoder, roomgraph)

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

const ObjectDatabase& cylindersAndDoors() {
  static const ObjectDatabase db =
      ObjectDatabase::fromText("[swivel_chair]\nlabels = chair\nshape = cylinder\n[door]\nlabels = door\n");
  return db;
}

fs::path dataFolder() {
  const char* env = std::getenv("ROOMGRAPH_DATA");
  return env ? fs::path(env) : fs::path(ROOMGRAPH_SOURCE_DIR) / ".." / "shared" / "data";
}

fs::path modelFolder() {
  return dataFolder() / "models";
}

class DnnDetectorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("roomgraph_dnn_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void prepare(const std::string& ini) {
    Config::fromText("[detection]\n" + ini, "test").read("detection", detector_);
    detector_.setDatabase(cylindersAndDoors());
    detector_.prepare();
  }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  template <class E>
  std::string messageOf(const std::string& ini) {
    try {
      prepare(ini);
    } catch (const E& error) {
      return error.what();
    }
    return "no error";
  }
  static Frame frame(int id) {
    Frame out;
    out.id = FrameId{id};
    out.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar(90, 120, 150));
    cv::rectangle(out.color, {200, 100}, {330, 400}, {20, 40, 60}, cv::FILLED);
    return out;
  }

  fs::path folder_;
  DnnDetector detector_;
};

TEST_F(DnnDetectorTest, WithoutNetworkTheReasonNamesSuitableOnes) {
  prepare("");
  const auto found = detector_.detect(frame(0));
  ASSERT_FALSE(found);
  EXPECT_THAT(found.reason(), AllOf(HasSubstr("[detection] models"), HasSubstr("NanoDet-Plus-m-1.5x"),
                                    HasSubstr("github.com/")));
}

// A convolution whose weights are unknown and whose bias is empty: OpenCV 4.6 divides by zero.
TEST_F(DnnDetectorTest, AModelAtWhichOpenCvCrashesIsNamed) {
  const std::string sound = test::tinyOnnx();
  write("labels.txt", "chair\nsofa\ndoor\n");
  EXPECT_EQ(messageOf<InputError>("models = " + write("sound.onnx", sound) + "\ninput_size_px = 32"), "no error");
  std::string damaged = sound;
  const auto replace = [&](const std::string& what, const std::string& with) {
    const auto at = damaged.find(what);
    ASSERT_NE(at, std::string::npos);
    damaged.replace(at, what.size(), with);
  };
  replace("weights\x0a\x04" "bias", "strange\x0a\x04" "bias");
  replace(std::string("bias\x4a\x08"), std::string("bias\x4a\0", 6));
  EXPECT_THAT(messageOf<InputError>("models = " + write("damaged.onnx", damaged)),
              AllOf(HasSubstr("damaged.onnx: not a network that OpenCV can load: it ended by signal 8")));
}

TEST_F(DnnDetectorTest, TheCalibrationOfItsScoresIsPartOfWhatANetworkIs) {
  write("labels.txt", "chair\nsofa\ndoor\n");
  const std::string models = "models = " + write("net.onnx", test::tinyOnnx()) + "\ninput_size_px = 32";
  std::vector<std::string> hashes;
  for (const char* shift : {"", "0", "1"}) {
    if (*shift) write("net.scores.json", std::string(R"({"classes": {"door": {"slope": 1, "shift": )") + shift + "}}}");
    prepare(models);
    hashes.push_back(detector_.identity().hash);
  }
  EXPECT_EQ(hashes[1].substr(0, hashes[0].size() + 1), hashes[0] + "~");
  EXPECT_NE(hashes[1], hashes[2]);
}

// Images come at 10 Hz; what is not looked for is what only the network with a rate finds.
TEST_F(DnnDetectorTest, ANetworkWithARateRunsOnFewerImages) {
  fs::create_directories(folder_ / "chairs");
  fs::create_directories(folder_ / "doors");
  write("chairs/labels.txt", "chair\nx\ny\n");
  write("doors/labels.txt", "door\nchair\ny\n");
  const std::string models = "models = " + write("chairs/a.onnx", test::tinyOnnx()) + ", " + write("doors/b.onnx", test::tinyOnnx()) +
                             "@2\ninput_size_px = 32\nscore_threshold = 0.01";
  prepare(models);
  const auto looks = [this](int count, bool foreseen_first) {
    std::vector<int> out;
    std::vector<Frame> frames;
    for (int i = 0; i < count; ++i) {
      frames.push_back(frame(i));
      frames.back().t = 100 + 0.1 * i;
      if (foreseen_first) detector_.foresee(frames.back());
    }
    for (int i = 0; i < count; ++i) {
      EXPECT_TRUE(detector_.detect(frames[static_cast<std::size_t>(i)]));
      if (detector_.unsought().empty()) out.push_back(i);
      else
        EXPECT_THAT(detector_.unsought(), ::testing::ElementsAre("door")) << "chairs are looked for by both";
    }
    return out;
  };
  EXPECT_THAT(looks(12, false), ::testing::ElementsAre(0, 5, 10));
  prepare(models);
  EXPECT_THAT(looks(12, true), ::testing::ElementsAre(0, 5, 10)) << "looked at before their turn";
}

TEST_F(DnnDetectorTest, ANetworkThatIsNotDueDoesNotRun) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a process of its own: this one keeps its registry
  write("labels.txt", "door\nx\ny\n");
  const std::string file = write("doors.onnx", test::tinyOnnx());
  const auto times_run = [&] {
    mrpt::rtti::registerClass(CLASS_ID(CountingDecoder));
    prepare("models = " + file + ":counting@2\ninput_size_px = 32");
    CountingDecoder::runs = 0;
    for (int i = 0; i < 12; ++i) {
      Frame image = frame(i);
      image.t = 100 + 0.1 * i;
      const bool due = detector_.due(image);
      const auto found = detector_.detect(image);
      if (due != detector_.unsought().empty()) std::_Exit(98);
      if (!found || found->size() != (detector_.unsought().empty() ? 1u : 0u)) std::_Exit(99);
    }
    std::_Exit(CountingDecoder::runs);
  };
  EXPECT_EXIT(times_run(), ::testing::ExitedWithCode(3), "") << "at 0, .5 and 1 s";
}

TEST_F(DnnDetectorTest, BrokenModelFilesAreNamed) {
  EXPECT_THAT(messageOf<InputError>("models = /nowhere/x.onnx"),
              HasSubstr("/nowhere/x.onnx: no such network"));
  const std::string model = write("junk.onnx", "this is not a network");
  EXPECT_THAT(messageOf<InputError>("models = " + model),
              AllOf(HasSubstr(model), HasSubstr("not a network")));
  EXPECT_THAT(messageOf<InputError>("models = " + write("a.txt", "x")),
              HasSubstr("not a network file; known"));
  EXPECT_THAT(messageOf<InputError>("models = " + write("a.weights", "x")),
              HasSubstr("a.cfg: no such Darknet"));
  write("a.cfg", "[net]\nbatch=1\n");
  EXPECT_THAT(messageOf<InputError>("models = " + (folder_ / "a.weights").string()), HasSubstr("a"));
  EXPECT_THAT(messageOf<InputError>("models = " + model + "\nlabels_file = /nowhere/names.txt"),
              HasSubstr("/nowhere/names.txt: no such label file"));
}

TEST_F(DnnDetectorTest, UnknownFormatListsTheKnown) {
  EXPECT_THAT(messageOf<ConfigError>("models = a.onnx:nanodett"),
              AllOf(HasSubstr("nanodett"), HasSubstr("known: auto, ade20k, darknet, nanodet, room, yolox")));
}

TEST_F(DnnDetectorTest, MadeByClassName) {
  detection::registerClasses();
  detection::registerClasses();
  EXPECT_NE(createStage<Detector>("AutoDetector", "[detection] class"), nullptr);
  EXPECT_NE(createStage<Detector>("DnnDetector", "[detection] class"), nullptr);
  EXPECT_NE(createStage<Detector>("RecordedDetector", "[detection] class"), nullptr);
}

// The four networks that the README names load, tell their format, and run.
TEST_F(DnnDetectorTest, KnownNetworksRun) {
  if (!fs::exists(modelFolder())) GTEST_SKIP() << "no networks in " << modelFolder();
  for (const char* file : {"nanodet-plus-m-1.5x/nanodet-plus-m_1.5x-320.onnx", "yolox-nano/yolox_nano.onnx",
                           "yolo-fastest-1.1-xl/yolo-fastest-1.1-xl.weights",
                           "deeplabv3-mnv2-ade20k/deeplabv3_mnv2_ade20k_256x256.onnx"}) {
    SCOPED_TRACE(file);
    prepare("models = " + (modelFolder() / file).string());
    EXPECT_TRUE(detector_.detect(frame(1)));
    Frame gray = frame(0);
    gray.color.release();
    EXPECT_THAT(detector_.detect(gray).reason(), HasSubstr("no colour image"));
  }
}

// A real photo with two chairs: boxes of several networks are fused, and the labels that count are those of
// the object database.
TEST_F(DnnDetectorTest, SeveralNetworksAndTheLabelsOfTheDatabase) {
  const fs::path photo = dataFolder() / "rgbd/fr3_office_10hz/rgb/1341847980.722988.jpg";
  const std::string nanodet = (modelFolder() / "nanodet-plus-m-1.5x/nanodet-plus-m_1.5x-416.onnx").string();
  const std::string yolox = (modelFolder() / "yolox-nano/yolox_nano.onnx").string();
  if (!fs::exists(photo) || !fs::exists(nanodet) || !fs::exists(yolox))
    GTEST_SKIP() << "no " << photo << " or networks in " << modelFolder();
  Frame seen = frame(0);
  seen.color = cv::imread(photo.string());
  const auto found = [&](const std::string& models) {
    prepare("models = " + models);
    const auto out = detector_.detect(seen);
    EXPECT_TRUE(out) << out.reason();
    return *out;
  };
  const auto one = found(nanodet), other = found(yolox), both = found(nanodet + ", " + yolox);
  EXPECT_THAT(detector_.identity().model, "nanodet-plus-m_1.5x-416+yolox_nano");
  ASSERT_GE(one.size(), 2u);
  const auto twice = found(nanodet + ", " + nanodet);
  ASSERT_EQ(twice.size(), one.size()) << "the same box twice is one";
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_GT(iou(twice[i].box, one[i].box), 1 - 1e-9);
    EXPECT_NEAR(twice[i].score, 1 - std::pow(1 - one[i].score, 2), 1e-12) << "two say so";
  }
  for (const auto& box : both) {
    EXPECT_EQ(box.class_name, "swivel_chair");
    EXPECT_EQ(box.label, "chair");
  }
  // Every box of either network is there, or one that overlaps it much and is better.
  for (const auto* single : {&one, &other})
    for (const auto& box : *single)
      EXPECT_TRUE(std::any_of(both.begin(), both.end(), [&](const Detection& kept) {
        return iou(kept.box, box.box) > 0.5 && kept.score >= box.score;
      }));
  const auto flasks = ObjectDatabase::fromText("[flask]\nlabels = Bottle, jar\nshape = cylinder\n");
  detector_.setDatabase(flasks);
  const auto renamed = detector_.detect(seen);
  ASSERT_TRUE(renamed);
  ASSERT_FALSE(renamed->empty()) << "the bottles on the desk";
  for (const auto& box : *renamed) EXPECT_EQ(box.class_name + " " + box.label, "flask bottle");
}

TEST_F(DnnDetectorTest, AWrongFormatIsRefused) {
  const fs::path file = modelFolder() / "yolox-nano/yolox_nano.onnx";
  if (!fs::exists(file)) GTEST_SKIP() << "no network " << file;
  EXPECT_THAT(messageOf<InputError>("models = " + file.string() + ":nanodet"),
              HasSubstr("not the format 'nanodet'"));
}

}  // namespace
}  // namespace roomgraph
