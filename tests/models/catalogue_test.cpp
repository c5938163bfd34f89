// SPDX-License-Identifier: BSD-3-Clause
// NetworkCatalogue: what it reads, and what it refuses.
#include "roomgraph/models/catalogue.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "made_up_network.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

json sample() {
  return json::parse(catalogueText({{"first", "objects", "both", {{"a.onnx", "abc"}}, "http://a.org"},
                                    {"second", "doors", "both", {{"b.weights", "b"}, {"b.cfg", "cc"}}}}));
}

std::string refused(const json& catalogue) {
  return messageOf<ConfigError>([&] { NetworkCatalogue::fromText(catalogue.dump(), "my.json"); });
}

TEST(NetworkCatalogue, ReadsNetworksInTheirOrder) {
  const auto catalogue = NetworkCatalogue::fromText(sample().dump());
  ASSERT_EQ(catalogue.networks().size(), 2u);
  const KnownNetwork& first = catalogue.networks()[0];
  EXPECT_EQ(first.name, "first");
  EXPECT_EQ(first.licence, "BSD-3-Clause");
  EXPECT_EQ(first.measured.precision, 0.25);
  ASSERT_EQ(first.files.size(), 1u);
  EXPECT_EQ(first.files[0].url, "http://a.org/a.onnx");
  EXPECT_EQ(first.files[0].sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_TRUE(first.published());
  EXPECT_FALSE(catalogue.network("second").published());
  EXPECT_EQ(catalogue.network("second").bytes(), 3u);
}

TEST(NetworkCatalogue, ListsOfLabelsBecomeFiles) {
  json catalogue = sample();
  catalogue["label_lists"] = {{"few", {"chair", "door"}}};
  catalogue["networks"][0]["files"].push_back(
      {{"name", "labels.txt"}, {"bytes", 11}, {"sha256", sha256Of("chair\ndoor\n")}, {"labels", "few"}});
  const auto read = NetworkCatalogue::fromText(catalogue.dump());
  EXPECT_EQ(read.networks()[0].files[1].content, "chair\ndoor\n");
  EXPECT_TRUE(read.networks()[0].published());
  catalogue["label_lists"]["few"].push_back("sofa");
  EXPECT_THAT(refused(catalogue), AllOf(HasSubstr("labels.txt"), HasSubstr("size or sha256")));
  catalogue["networks"][0]["files"][1]["labels"] = "many";
  EXPECT_THAT(refused(catalogue), HasSubstr("a list of labels that is not there"));
}

TEST(NetworkCatalogue, AnUnknownNameIsAnsweredByTheKnown) {
  const auto catalogue = NetworkCatalogue::fromText(sample().dump());
  EXPECT_THAT(
      messageOf<ConfigError>([&] { (void)catalogue.network("secnd"); }),
      AllOf(HasSubstr("'secnd'"), HasSubstr("did you mean 'second'"), HasSubstr("known: first, second")));
}

TEST(NetworkCatalogue, NamesCannotLeadOutOfTheFolder) {
  for (const char* name : {"../evil", "a/b", "", ".hidden", "a b"}) {
    json network = sample(), file = sample(), subfolder = sample();
    network["networks"][1]["name"] = name;
    file["networks"][1]["files"][0]["name"] = name;
    subfolder["networks"][1]["subfolder"] = name;
    for (const auto& catalogue : {network, file, subfolder})
      EXPECT_THAT(refused(catalogue), AllOf(HasSubstr("my.json: network 2"), HasSubstr("no plain name")))
          << name;
  }
}

TEST(NetworkCatalogue, WhatIsBrokenIsNamed) {
  json twice = sample();
  twice["networks"][1]["name"] = "first";
  EXPECT_THAT(refused(twice), HasSubstr("the name first is taken"));
  json digits = sample();
  digits["networks"][0]["files"][0]["sha256"] = std::string(64, 'G');
  EXPECT_THAT(refused(digits), HasSubstr("hexadecimal"));
  digits["networks"][0]["files"][0]["sha256"] = "abc";
  EXPECT_THAT(refused(digits), HasSubstr("64"));
  json empty = sample();
  empty["networks"][0]["files"] = json::array();
  EXPECT_THAT(refused(empty), HasSubstr("has no files"));
  json same = sample();
  same["networks"][1]["files"][1]["name"] = "b.weights";
  EXPECT_THAT(refused(same), HasSubstr("two files are named b.weights"));
  json nameless = sample();
  nameless["networks"][0].erase("name");
  EXPECT_THAT(refused(nameless), AllOf(HasSubstr("network 1"), HasSubstr("name")));
  EXPECT_THAT(messageOf<ConfigError>([] { NetworkCatalogue::fromText("{", "my.json"); }),
              AllOf(HasSubstr("my.json"), HasSubstr("not valid JSON")));
  EXPECT_THAT(messageOf<InputError>([] { NetworkCatalogue::fromFile("/nowhere/x.json"); }),
              HasSubstr("/nowhere/x.json"));
}

}  // namespace
}  // namespace roomgraph::test
