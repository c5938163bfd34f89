// SPDX-License-Identifier: BSD-3-Clause
// The catalogue that is shipped: complete, and true of the networks' files where they are at hand.
#include <gmock/gmock.h>

#include "data_folder.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/models/fetch.h"
#include "roomgraph/models/model_folder.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
namespace fs = std::filesystem;

NetworkCatalogue shipped() {
  return NetworkCatalogue::fromFile(fs::path(ROOMGRAPH_SOURCE_DIR) / "networks.json");
}

std::vector<std::string> namesOf(const std::vector<KnownNetwork>& networks) {
  std::vector<std::string> names;
  for (const auto& network : networks) names.push_back(network.name);
  return names;
}

TEST(ShippedCatalogue, NamesTheNetworksBestFirst) {
  EXPECT_THAT(namesOf(shipped().networks()),
              ElementsAre("nanodet-plus-m-1.5x-416", "nanodet-plus-m-1.5x-320", "yolox-nano",
                          "yolo-fastest-1.1-xl", "deeplabv3-mnv2-ade20k"));
}

TEST(ShippedCatalogue, SaysAllAboutEach) {
  const auto catalogue = shipped();
  for (const auto& network : catalogue.networks()) {
    for (const auto& text : {network.author, network.licence, network.note, network.measured.on})
      EXPECT_FALSE(text.empty()) << network.name;
    EXPECT_TRUE(network.project.starts_with("https://github.com/")) << network.name;
    EXPECT_FALSE(network.finds.empty()) << network.name;
    EXPECT_GT(network.measured.forward_ms, 0) << network.name;
    EXPECT_EQ(network.files.back().name, "labels.txt") << network.name;
    for (const auto& file : network.files)
      if (!file.url.empty()) {
        EXPECT_TRUE(file.url.starts_with("https://") && file.url.ends_with("/" + file.name)) << file.url;
      }
    EXPECT_EQ(network.published(), network.name.starts_with("yolo")) << network.name;
    EXPECT_EQ(network.role, network.finds == std::vector<std::string>{"door"} ? "doors" : "objects");
  }
}

TEST(ShippedCatalogue, FetchesTheRealFilesFromAFolder) {
  const fs::path source = dataFolder() / "models";
  if (!fs::is_directory(source)) GTEST_SKIP() << "no networks in " << source;
  TemporaryFolder folder;
  FetchListener nobody;
  const auto catalogue = shipped();
  for (const auto& network : catalogue.networks()) {
    fetchNetwork(network, folder.path(), source.string(), nobody);
    EXPECT_TRUE(isInstalled(network, folder.path()));
    EXPECT_THAT(faultsOf(network, folder.path()), ElementsAre()) << network.name;
    const fs::path labels = source / network.subfolder / "labels.txt";
    EXPECT_EQ(sha256OfFile(labels), network.files.back().sha256)
        << "the labels of the collection are the catalogue's";
  }
  EXPECT_THAT(namesOf(networksToRun(catalogue, folder.path())),
              ElementsAre("nanodet-plus-m-1.5x-416", "deeplabv3-mnv2-ade20k"));
  fs::remove(networkFile(catalogue.networks()[0], folder.path()));
  EXPECT_THAT(namesOf(networksToRun(catalogue, folder.path())),
              ElementsAre("nanodet-plus-m-1.5x-320", "deeplabv3-mnv2-ade20k"));
}

}  // namespace
}  // namespace roomgraph::test
