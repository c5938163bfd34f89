// SPDX-License-Identifier: BSD-3-Clause
// Every file reader on hundreds of randomly damaged files: an Error or success, with bounded memory.
#include <gmock/gmock.h>

#include <cstdlib>
#include <type_traits>

#include "memory_limit.h"
#include "mutate.h"
#include "recorded_detector.h"
#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/datasets/rawlog_copy.h"
#include "roomgraph/datasets/rawlog_peek.h"
#include "roomgraph/datasets/rawlog_report.h"
#include "roomgraph/evaluation/frame_files.h"
#include "roomgraph/evaluation/object_files.h"
#include "roomgraph/evaluation/relations.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/pipeline/setup.h"
#include "roomgraph/simulation/world_file.h"
#include "sample_map.h"
#include "temporary_folder.h"
#include "three_frames.h"

// Every reader gets 500 damaged files, or as many as the environment variable ROOMGRAPH_MUTATIONS says. It
// may use what is left or throw an Error with its exit code; nothing else: no other exception, no crash, no
// gigabytes.

namespace roomgraph::test {
namespace {

unsigned seeds() {
  const char* asked_for = std::getenv("ROOMGRAPH_MUTATIONS");
  return asked_for ? static_cast<unsigned>(std::strtoul(asked_for, nullptr, 10)) : 500u;
}

constexpr double kMostMegabytes = 1024;  // more than before

using Path = std::filesystem::path;

class Mutation : public ::testing::Test {
 protected:
  /// `read` may return whether it noticed damage that it could step over.
  template <class Read>
  void expectSurvival(const std::string& good, bool binary, const Read& read) {
    if (binary && !kMemoryCanBeLimited) GTEST_SKIP() << "sizes are damaged; not under this sanitizer";
    limitAddressSpace();
    read(folder.write("good", good));
    const double before = peakMegabytes();
    unsigned noticed = 0;
    for (unsigned seed = 1; seed <= seeds(); ++seed) {
      Mutator mutator(seed);
      const auto file = folder.write("bad", binary ? mutator.binary(good) : mutator.text(good));
      try {
        if constexpr (std::is_same_v<decltype(read(file)), bool>)
          noticed += read(file);
        else
          read(file);
      } catch (const Error&) {
        ++noticed;
      } catch (const std::exception& error) {
        ADD_FAILURE() << "seed " << seed << ": " << error.what();
      }
      // A sanitizer keeps freed memory to find its later use.
      if (kMemoryCanBeLimited) {
        ASSERT_LT(peakMegabytes() - before, kMostMegabytes) << "seed " << seed;
      }
    }
    EXPECT_GT(noticed, seeds() / 10) << "damage is hardly ever noticed";
  }

  const TemporaryFolder folder;
};

std::string sourceFile(const std::string& name) {
  return test::readBytes(Path(ROOMGRAPH_SOURCE_DIR) / name);
}

TEST_F(Mutation, RawlogReplayed) {
  expectSurvival(threeFrames().bytes(), true, [](const Path& file) {
    RawlogReader reader(file);
    while (const auto record = reader.next()) EXPECT_TRUE(isFinite(*record));
    return !reader.statistics().skipped.empty() || !reader.statistics().warning.empty();
  });
}

TEST_F(Mutation, DetectionsInComments) {
  std::string good;
  for (int i = 0; i < 4; ++i) {
    good += test::bytesOf(test::makeScan(1000 + 0.1 * i));
    const auto comment = mrpt::obs::CObservationComment::Create();
    *comment = toComment(*makeDetections(1000 + 0.1 * i));
    good += test::bytesOf(comment);
  }
  expectSurvival(good, false, [](const Path& file) {
    RawlogReader reader(file);
    while (const auto record = reader.next()) EXPECT_TRUE(isFinite(*record));
    return !reader.statistics().skipped.empty() || !reader.statistics().warning.empty();
  });
}

TEST_F(Mutation, RawlogInspected) {
  expectSurvival(threeFrames().bytes(), true, [](const Path& file) {
    const auto report = inspectRawlog(file);
    return !report.skipped.empty() || !report.truncation.empty();
  });
}

TEST_F(Mutation, RawlogOfPairs) {
  expectSurvival(threePairs().bytes(), true, [](const Path& file) {
    const auto report = inspectRawlog(file);
    RawlogReader reader(file);
    while (const auto record = reader.next()) EXPECT_TRUE(isFinite(*record));
    return !reader.statistics().skipped.empty() || !reader.statistics().warning.empty() ||
           !report.skipped.empty();
  });
}

TEST_F(Mutation, RawlogPeekedIntoAndCopied) {
  if (!kMemoryCanBeLimited) GTEST_SKIP() << "sizes are damaged; not under this sanitizer";
  limitAddressSpace();
  const auto peekAndCopy = [this](const Path& file) {
    peekRawlog(file);
    RawlogCopy copy(file, folder.file("copy.rawlog"));
    copy.insert(*makeDetections(1000.15));
    copy.finish();
  };
  for (const auto& good : {threeFrames().bytes(), threePairs().bytes()})
    for (unsigned seed = 1; seed <= seeds(); ++seed) {
      Mutator mutator(seed);
      const auto file = folder.write("bad", mutator.binary(good));
      try {
        peekAndCopy(file);
      } catch (const Error&) {
        // not even the beginning can be read
      }
    }
}

TEST_F(Mutation, GzippedRawlog) {
  test::writeRawlog(folder.file("x.rawlog"), threeFrames().records);
  expectSurvival(folder.read("x.rawlog"), true, [](const Path& file) {
    const auto report = inspectRawlog(file);
    return !report.skipped.empty() || !report.truncation.empty();
  });
}

// With a checksum that fits the damage: what lies behind it is met.
TEST_F(Mutation, Map) {
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << sampleMap();
  const std::string plain(static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount());
  expectSurvival(plain, true, [&](const Path& file) {
    const std::string bytes = folder.read(file.filename().string());
    loadMap(folder.write("summed", bytes + "roomgraph map sha256 " + sha256Of(bytes)));
  });
}

TEST_F(Mutation, GzippedMap) {
  saveMap(sampleMap(), folder.file("map.rgmap"));
  expectSurvival(folder.read("map.rgmap"), true, [](const Path& file) { loadMap(file); });
}

TEST_F(Mutation, PoseGraph) {
  std::string good = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nFIX 0\n# LANDMARK 3 1 cuboid 0.5 0.5 1\n";
  const std::string information = " 100 0 0 0 0 0 100 0 0 0 0 100 0 0 0 400 0 0 400 0 400\n";
  for (int i = 1; i <= 3; ++i) {
    const auto id = std::to_string(i), from = std::to_string(i - 1);
    good += "VERTEX_SE3:QUAT " + id + " " + id + " 0 0 0 0 0 1\n";
    good += "EDGE_SE3:QUAT " + from + " " + id + " 1.1 0.1 0 0 0 0.0998334 0.9950042" + information;
  }
  expectSurvival(good, false, [](const Path& file) {
    auto content = loadG2o(file);
    if (auto* graph = std::get_if<FactorGraph>(&content.graph)) {
      graph->optimize(3);
      graph->landmarkCovariances();
    }
  });
}

TEST_F(Mutation, PlanarPoseGraph) {
  std::string good = "VERTEX_SE2 0 0 0 0\n";
  for (int i = 1; i <= 5; ++i) {
    const auto id = std::to_string(i), from = std::to_string(i - 1);
    good += "VERTEX_SE2 " + id + " " + id + ".2 0.1 0.3\n";
    good += "EDGE_SE2 " + from + " " + id + " 1.1 0.1 0.2 100 1 2 100 3 400\n";
  }
  expectSurvival(good, false, [](const Path& file) {
    auto content = loadG2o(file);
    if (auto* graph = std::get_if<PlanarGraph>(&content.graph)) {
      initializePoses(*graph);
      optimize(*graph, {.max_iterations = 3});
    }
  });
}

TEST_F(Mutation, Landmarks) {
  saveLandmarksJson(sampleMap().landmarks, folder.file("landmarks.json"));
  expectSurvival(folder.read("landmarks.json"), false, [](const Path& file) { readObjects(file); });
}

TEST_F(Mutation, World) {
  expectSurvival(sourceFile("rawlogs/tiny_room.json"), false, [](const Path& file) { readWorld(file); });
}

TEST_F(Mutation, Config) {
  expectSurvival(sourceFile("config.ini"), false, [](const Path& file) {
    makeSetup(Config::fromFile(file), ROOMGRAPH_SOURCE_DIR "/objects.ini");
  });
}

TEST_F(Mutation, Objects) {
  expectSurvival(sourceFile("objects.ini"), false, [](const Path& file) { ObjectDatabase::fromFile(file); });
}

TEST_F(Mutation, Detections) {
  std::string good;
  for (int i = 0; i < 4; ++i)
    good += R"({"timestamp": 1000.)" + std::to_string(i) +
            R"(, "boxes": [{"class": "chair", "score": 0.75, "bbox": [10.5, 20, 110, 220.25], "track": 3}]})"
            "\n";
  expectSurvival(good, false, [](const Path& file) { readDetectionFile(file.string()); });
  expectSurvival(good, false, [](const Path& file) { readDetections(file); });
}

TEST_F(Mutation, TrueBoxes) {
  std::string good;
  for (int i = 0; i < 4; ++i)
    good +=
        R"({"frame": 1, "t": 1000.)" + std::to_string(i) +
        R"(, "objects": [{"id": 2, "class": "sofa", "kind": "sofa", "bbox": [1, 2, 3, 4.5], "visible": 0.9, "z_med": 2.5}]})"
        "\n";
  expectSurvival(good, false, [](const Path& file) { readTrueFrames(file); });
  expectSurvival(good, false, [](const Path& file) { readSeenObjects(file, {}); });
}

TEST_F(Mutation, Trajectory) {
  std::string poses, relations;
  for (int i = 0; i < 9; ++i) {
    poses += "1000." + std::to_string(i) + " 0.1 0.2 0.3 0 0 0.0998334 0.9950042\n";
    relations += "1000." + std::to_string(i) + " 1001 0.1 0.2 0.3 0 0 0.1\n";
  }
  expectSurvival(poses, false, [](const Path& file) { readTrajectory(file); });
  expectSurvival(relations, false, [](const Path& file) { readRelations(file); });
}

TEST_F(Mutation, OccupancyMap) {
  saveOccupancyRos(*sampleMap().occupancy, folder.file("map"));
  std::string yaml = folder.read("map.yaml");
  yaml.replace(yaml.find("map.pgm"), 7, folder.file("map.pgm").string());
  expectSurvival(yaml, false, [](const Path& file) { loadOccupancyRos(file); });
  expectSurvival(folder.read("map.pgm"), true, [&](const Path& file) {
    std::filesystem::copy_file(file, folder.file("map.pgm"),
                               std::filesystem::copy_options::overwrite_existing);
    loadOccupancyRos(folder.file("map.yaml"));
  });
}

}  // namespace
}  // namespace roomgraph::test
