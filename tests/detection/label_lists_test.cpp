// SPDX-License-Identifier: BSD-3-Clause
// Label lists: lengths, order of published networks, and labels files.
#include "label_lists.h"

#include <gmock/gmock.h>

#include <set>

#include "data_folder.h"
#include "dnn_detector.h"
#include "errors_of.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/observations/object_database.h"
#include "tiny_network.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

fs::path modelFolder() {
  return dataFolder() / "models";
}

std::vector<std::string> linesOf(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

const std::vector<std::string>& listOf(std::size_t size) {
  for (const auto& list : labelLists())
    if (list.labels.size() == size) return list.labels;
  throw std::out_of_range("no list of " + std::to_string(size));
}

void prepareDnn(DnnDetector& detector, const std::string& ini) {
  Config::fromText("[detection]\n" + ini, "test").read("detection", detector);
  detector.prepare();
}

std::string errorOf(const std::string& ini) {
  return messageOf<InputError>([&] {
    DnnDetector detector;
    prepareDnn(detector, ini);
  });
}

TEST(LabelLists, EachLengthAndEachLabelOnce) {
  std::set<std::size_t> sizes;
  for (const auto& [name, labels] : labelLists()) {
    EXPECT_TRUE(sizes.insert(labels.size()).second) << name;
    EXPECT_EQ(std::set<std::string>(labels.begin(), labels.end()).size(), labels.size()) << name;
  }
  EXPECT_EQ(sizes, (std::set<std::size_t>{32, 80, 150, 151}));
  EXPECT_EQ(listOf(80)[56], "chair");
  EXPECT_EQ(listOf(150)[14], "door");
  EXPECT_EQ(listOf(150)[149], "flag");
  EXPECT_EQ(listOf(151)[15], "door");
  EXPECT_EQ(listOf(32).back(), "armchair");
}

// Some spell a class otherwise (sofa, couch): what counts is the class of the shipped database.
TEST(LabelLists, HaveTheOrderOfPublishedNetworks) {
  if (!fs::exists(modelFolder())) GTEST_SKIP() << "no networks in " << modelFolder();
  const auto database = ObjectDatabase::fromFile(fs::path(ROOMGRAPH_SOURCE_DIR) / "objects.ini");
  const std::vector<std::pair<std::string, std::size_t>> networks = {{"nanodet-plus-m-1.5x", 80},
                                                                     {"yolox-nano", 80},
                                                                     {"yolo-fastest-1.1-xl", 80},
                                                                     {"deeplabv3-mnv2-ade20k", 32}};
  for (const auto& [network, size] : networks) {
    const auto theirs = linesOf(modelFolder() / network / "labels.txt"), ours = listOf(size);
    ASSERT_EQ(theirs.size(), size) << network;
    std::size_t same = 0;
    for (std::size_t i = 0; i < size; ++i) {
      EXPECT_EQ(database.byLabel(theirs[i]), database.byLabel(ours[i])) << theirs[i] << ", " << ours[i];
      same += theirs[i] == ours[i];
    }
    EXPECT_GE(same, size - 8) << network;
  }
}

TEST(LabelLists, AreUsedWhenNoFileSaysMore) {
  TemporaryFolder folder;
  const std::string network = writeTinyNetwork(folder, 80).string();
  DnnDetector detector;
  EXPECT_NO_THROW(prepareDnn(detector, "models = " + network));
  std::string labels;
  for (int i = 0; i < 80; ++i) labels += "label " + std::to_string(i) + "\n";
  folder.write("labels.txt", labels);
  EXPECT_NO_THROW(prepareDnn(detector, "models = " + network)) << "a file beside the network comes first";
  folder.write("labels.txt", labels + "one more\n");
  EXPECT_THAT(errorOf("models = " + network),
              AllOf(HasSubstr("81 labels in"), HasSubstr("labels.txt"), HasSubstr("fits none")));
  EXPECT_THAT(errorOf("models = " + network + "\nlabels_file = /nowhere/names.txt"),
              HasSubstr("/nowhere/names.txt"));
}

TEST(LabelLists, AnUnusualNumberOfClassesNeedsAFile) {
  TemporaryFolder folder;
  const std::string network = writeTinyNetwork(folder, 3).string();
  EXPECT_THAT(errorOf("models = " + network),
              AllOf(HasSubstr("tiny.weights"), HasSubstr("COCO 80"), HasSubstr("ADE20K 150"),
                    HasSubstr("put labels.txt beside it"), HasSubstr("labels_file")));
  folder.write("labels.txt", "mug\nplate\nspoon\n");
  DnnDetector detector;
  EXPECT_NO_THROW(prepareDnn(detector, "models = " + network));
}

// Real files, away from their labels.txt; each tells its classes by its output.
TEST(LabelLists, PublishedNetworksNeedNoFile) {
  if (!fs::exists(modelFolder())) GTEST_SKIP() << "no networks in " << modelFolder();
  TemporaryFolder folder;
  std::string models;
  for (const char* file : {"nanodet-plus-m-1.5x/nanodet-plus-m_1.5x-320.onnx", "yolox-nano/yolox_nano.onnx",
                           "deeplabv3-mnv2-ade20k/deeplabv3_mnv2_ade20k_256x256.onnx"}) {
    const fs::path link = folder.file(fs::path(file).filename().string());
    fs::create_symlink(fs::absolute(modelFolder() / file), link);
    models += (models.empty() ? "" : ", ") + link.string();
  }
  DnnDetector detector;
  EXPECT_NO_THROW(prepareDnn(detector, "models = " + models));
}

}  // namespace
}  // namespace roomgraph::test
