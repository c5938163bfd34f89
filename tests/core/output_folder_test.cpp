// SPDX-License-Identifier: BSD-3-Clause
// OutputFolder: publication, recovery after a kill, locking, inputs and signal handlers.
#include "roomgraph/core/output_folder.h"

#include <gmock/gmock.h>

#include <csignal>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using ::testing::HasSubstr;

class OutputFolderTest : public ::testing::Test {
 protected:
  void put(const OutputFolder& out, const std::string& name, const std::string& text) {
    std::ofstream(out.pending(name)) << text;
  }
  TemporaryFolder folder;
  const std::vector<std::string> names{"path", "picture", "summary"};
};

TEST_F(OutputFolderTest, FormerResultsStayUntilTheNewOnesAreWhole) {
  for (const auto& name : names) folder.write(name, "old");
  folder.write("notes of the user", "mine");
  {
    OutputFolder out(folder.path(), names);
    put(out, "path", "half");
  }
  EXPECT_EQ(folder.read("path"), "old");
  EXPECT_EQ(folder.count(), 4u) << "nothing is left of what was given up";

  OutputFolder out(folder.path(), names);
  put(out, "path", "new");
  put(out, "summary", "new");
  out.publish();
  EXPECT_EQ(folder.read("path"), "new");
  EXPECT_EQ(folder.read("summary"), "new");
  EXPECT_EQ(folder.read("notes of the user"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder.file("picture"))) << "of the former results";
  EXPECT_EQ(folder.count(), 3u);
}

TEST_F(OutputFolderTest, WhatAKilledProcessLeftIsRemoved) {
  std::filesystem::create_directory(folder.file("roomgraph_unfinished"));
  folder.write("roomgraph_unfinished/picture", "of long ago");
  OutputFolder out(folder.path(), names);
  put(out, "summary", "new");
  out.publish();
  EXPECT_EQ(folder.count(), 1u);
}

// Killed between two files: what is whole is put into place before anything else happens.
TEST_F(OutputFolderTest, ChangingPlacesIsGoneOnWith) {
  folder.write("path", "new, in its place already");
  folder.write("picture", "old");
  std::filesystem::create_directory(folder.file("roomgraph_unfinished"));
  folder.write("roomgraph_unfinished/summary", "new");
  folder.write("roomgraph_unfinished/complete", "path\nsummary\n");
  { const OutputFolder next(folder.path(), names); }
  EXPECT_EQ(folder.read("path"), "new, in its place already");
  EXPECT_EQ(folder.read("summary"), "new");
  EXPECT_EQ(folder.count(), 2u);
}

TEST_F(OutputFolderTest, IsLockedWhileInUse) {
  {
    const OutputFolder first(folder.path(), names);
    EXPECT_THAT(messageOf<RunError>([&] { OutputFolder second(folder.path(), names); }),
                HasSubstr("another process is writing into it"));
    EXPECT_TRUE(std::filesystem::exists(folder.file("roomgraph_unfinished"))) << "the first one's work";
  }
  EXPECT_NO_THROW(OutputFolder(folder.path(), names));
}

TEST_F(OutputFolderTest, InputsAreNotReplaced) {
  folder.write("path", "input");
  folder.write("other", "input");
  std::filesystem::create_symlink(folder.file("path"), folder.file("alias"));
  std::filesystem::create_directory(folder.file("roomgraph_unfinished"));
  const auto rescued = folder.write("roomgraph_unfinished/live", "left by a killed process, and read now");
  const auto with = [&](const std::filesystem::path& input) { OutputFolder(folder.path(), names, {input}); };
  EXPECT_THAT(messageOf<ConfigError>([&] { with(folder.file("path")); }), HasSubstr("choose another"));
  EXPECT_THAT(messageOf<ConfigError>([&] { with(folder.file("alias")); }), HasSubstr("alias"));
  EXPECT_THAT(messageOf<ConfigError>([&] { with(rescued); }), HasSubstr("live"));
  EXPECT_TRUE(std::filesystem::exists(rescued));
  EXPECT_NO_THROW(with(folder.file("other")));
  EXPECT_NO_THROW(with(folder.file("none")));
  EXPECT_NO_THROW(with(""));
}

TEST_F(OutputFolderTest, AFolderIsNotReplacedByAResult) {
  std::filesystem::create_directory(folder.file("picture"));
  EXPECT_THAT(messageOf<RunError>([&] { OutputFolder(folder.path(), names); }),
              HasSubstr("'picture' is a folder"));
  EXPECT_NO_THROW(OutputFolder(folder.file("other"), names));
}

TEST_F(OutputFolderTest, TheCheckpointVanishesWithThePublicationUnlessItIsKept) {
  const auto checkpoint = folder.file("roomgraph_checkpoint");
  std::filesystem::create_directory(checkpoint);
  folder.write("roomgraph_checkpoint/results", "of an hour");
  { const OutputFolder given_up(folder.path(), names); }
  EXPECT_TRUE(std::filesystem::exists(checkpoint / "results")) << "nothing was published";
  {
    OutputFolder out(folder.path(), names);
    EXPECT_EQ(out.checkpoint(), checkpoint);
    put(out, "summary", "of a part");
    out.publish(true);
    EXPECT_EQ(folder.read("summary"), "of a part");
  }
  EXPECT_TRUE(std::filesystem::exists(checkpoint / "results"));
  OutputFolder out(folder.path(), names);
  put(out, "summary", "of all");
  out.publish();
  EXPECT_EQ(folder.count(), 1u);
}

// Killed while files were being moved: whoever completes that also does what was to become of the checkpoint.
TEST_F(OutputFolderTest, TheCheckpointOfACompletedPublicationVanishes) {
  for (const std::string kept : {"", "/checkpoint\n"}) {
    std::filesystem::create_directory(folder.file("roomgraph_unfinished"));
    std::filesystem::create_directory(folder.file("roomgraph_checkpoint"));
    folder.write("roomgraph_unfinished/summary", "new");
    folder.write("roomgraph_unfinished/complete", kept + "summary\n");
    { const OutputFolder next(folder.path(), names); }
    EXPECT_EQ(folder.read("summary"), "new");
    EXPECT_EQ(std::filesystem::exists(folder.file("roomgraph_checkpoint")), !kept.empty());
  }
}

TEST_F(OutputFolderTest, AFolderThatVanishedIsNoticed) {
  const auto place = folder.file("out"), moved = folder.file("moved");
  OutputFolder out(place, names);
  put(out, "summary", "new");
  EXPECT_NO_THROW(out.requireInPlace());
  std::filesystem::rename(place, moved);
  EXPECT_THAT(messageOf<RunError>([&] { out.requireInPlace(); }), HasSubstr("vanished"));
  std::filesystem::create_directories(place / "roomgraph_unfinished");
  EXPECT_THAT(messageOf<RunError>([&] { out.publish(); }), HasSubstr("vanished"))
      << "another folder of that name";
  std::filesystem::remove_all(place);
  std::filesystem::rename(moved, place);
  EXPECT_NO_THROW(out.publish());
}

TEST_F(OutputFolderTest, ForeignNamesAreAMistakeOfTheProgram) {
  const OutputFolder out(folder.path(), names);
  EXPECT_THROW(out.pending("unknown"), std::logic_error);
}

int caught = 0;

TEST_F(OutputFolderTest, SignalHandlersAreAsBefore) {
  const auto former = std::signal(SIGTERM, [](int) { ++caught; });
  OutputFolder out(folder.path(), names);
  put(out, "summary", "new");
  out.publish();
  std::raise(SIGTERM);
  EXPECT_EQ(caught, 1);
  std::signal(SIGTERM, former);
}

}  // namespace
}  // namespace roomgraph
