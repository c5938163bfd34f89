// SPDX-License-Identifier: BSD-3-Clause
// The model folder: where it is, what counts as installed, which networks are chosen, what is wrong with
// them.
#include "roomgraph/models/model_folder.h"

#include <gmock/gmock.h>

#include "made_up_network.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// An environment variable that is as before at the end.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* former = std::getenv(name)) former_ = former;
    value ? setenv(name, value, 1) : unsetenv(name);
  }
  ~Variable() { former_.empty() ? unsetenv(name_) : setenv(name_, former_.c_str(), 1); }

 private:
  const char* name_;
  std::string former_;
};

TEST(ModelFolder, IsTheOneNamedElseTheUsers) {
  const Variable home("HOME", "/home_of/ann");
  const Variable data("XDG_DATA_HOME", "/data");
  EXPECT_EQ(modelFolder("/mine/../mine/x"), "/mine/x");
  EXPECT_EQ(modelFolder("x"), fs::current_path() / "x");
  EXPECT_EQ(modelFolder(""), "/data/roomgraph/models");
  {
    const Variable relative("XDG_DATA_HOME", "relative");
    EXPECT_EQ(modelFolder(""), "/home_of/ann/.local/share/roomgraph/models")
        << "as the XDG specification says";
  }
  const Variable none("XDG_DATA_HOME", nullptr);
  EXPECT_EQ(modelFolder(""), "/home_of/ann/.local/share/roomgraph/models");
  const Variable homeless("HOME", nullptr);
  EXPECT_EQ(modelFolder(""), "");
}

class Installed : public ::testing::Test {
 protected:
  void put(const KnownNetwork& network, const std::string& file, const std::string& content) {
    fs::create_directories(folderOf(network, models));
    std::ofstream(folderOf(network, models) / file, std::ios::binary) << content;
  }

  TemporaryFolder folder;
  fs::path models = folder.file("models");
  KnownNetwork pair = known({"pair", "objects", "c", {{"p.weights", "12345"}, {"p.cfg", "abc"}}});
};

TEST_F(Installed, OnlyWithAllFilesInFullSize) {
  EXPECT_FALSE(isInstalled(pair, models));
  EXPECT_FALSE(isBegun(pair, models));
  put(pair, "p.weights.part", "123");
  EXPECT_TRUE(isBegun(pair, models));
  put(pair, "p.weights", "12345");
  EXPECT_FALSE(isInstalled(pair, models)) << "the other file is missing";
  put(pair, "p.cfg", "ab");
  EXPECT_FALSE(isInstalled(pair, models)) << "half a file";
  put(pair, "p.cfg", "abc");
  EXPECT_TRUE(isInstalled(pair, models));
  EXPECT_EQ(networkFile(pair, models), models / "pair" / "p.weights");
  EXPECT_FALSE(isInstalled(pair, "")) << "no model folder";
}

TEST_F(Installed, FaultsAreNamedFileByFile) {
  put(pair, "p.weights", "12345");
  put(pair, "p.cfg", "abc");
  EXPECT_THAT(faultsOf(pair, models), ElementsAre());
  put(pair, "p.weights", "12346");
  put(pair, "p.cfg", "abcd");
  EXPECT_THAT(faultsOf(pair, models),
              ElementsAre(AllOf(HasSubstr("p.weights: has the SHA-256"), HasSubstr(pair.files[0].sha256)),
                          HasSubstr("p.cfg: has 4 bytes instead of 3")));
  fs::remove(models / "pair" / "p.cfg");
  fs::remove(models / "pair" / "p.weights");
  put(pair, "p.weights.part", "123");
  EXPECT_THAT(faultsOf(pair, models), ElementsAre(HasSubstr("p.weights: is not complete: 3 of 5 bytes"),
                                                  HasSubstr("p.cfg: is not there")));
}

TEST_F(Installed, OfEachRoleTheFirstOfTheCatalogueRuns) {
  const auto catalogue =
      NetworkCatalogue::fromText(catalogueText({{"best", "objects", "c", {{"a.onnx", "best"}}},
                                                {"good", "objects", "c", {{"b.onnx", "good"}}},
                                                {"poor", "objects", "c", {{"c.onnx", "poor"}}},
                                                {"door", "doors", "c", {{"d.onnx", "door"}}}}));
  const auto chosen = [&] {
    std::vector<std::string> names;
    for (const auto& network : networksToRun(catalogue, models)) names.push_back(network.name);
    return names;
  };
  EXPECT_THAT(chosen(), ElementsAre());
  put(catalogue.network("door"), "d.onnx", "door");
  put(catalogue.network("poor"), "c.onnx", "poor");
  EXPECT_THAT(chosen(), ElementsAre("poor", "door"));
  put(catalogue.network("good"), "b.onnx", "good");
  EXPECT_THAT(chosen(), ElementsAre("good", "door"));
  put(catalogue.network("best"), "a.onnx.part", "best");
  put(catalogue.network("best"), "a.onnx", "bes");
  EXPECT_THAT(chosen(), ElementsAre("good", "door")) << "a half file is not offered";
}

}  // namespace
}  // namespace roomgraph::test
