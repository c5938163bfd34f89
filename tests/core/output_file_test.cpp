// SPDX-License-Identifier: BSD-3-Clause
// Output files: full disk, atomic replacement, concurrent writers, inputs as outputs.
#include "roomgraph/core/output_file.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;
using test::messageOf;
using test::TemporaryFolder;

TEST(OutputFile, AFullDiskIsNamedWithItsFile) {
  OutputFile out("/dev/full");
  out << "text";
  EXPECT_THAT(messageOf<RunError>([&] { out.finish(); }), HasSubstr("/dev/full: No space left on device"));
  EXPECT_THAT(messageOf<RunError>([] { OutputFile("/no/such/folder/x"); }),
              HasSubstr("/no/such/folder/x: No such file or directory"));
}

TEST(PendingFile, ThePlaceKeepsItsContentUntilTheEnd) {
  TemporaryFolder folder;
  const auto place = folder.write("result", "old");
  {
    PendingFile pending(place);
    std::ofstream(pending.path()) << "half";
    EXPECT_EQ(folder.read("result"), "old");
  }
  EXPECT_EQ(folder.read("result"), "old");
  EXPECT_EQ(folder.count(), 1u) << "what was given up is removed";
  PendingFile pending(place);
  std::ofstream(pending.path()) << "new";
  pending.commit();
  EXPECT_EQ(folder.read("result"), "new");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(PendingFile, TwoWritersOfOneFileAreTold) {
  TemporaryFolder folder;
  const PendingFile first(folder.file("x"));
  EXPECT_THAT(messageOf<RunError>([&] { PendingFile second(folder.file("x")); }),
              HasSubstr("another process is writing it"));
}

TEST(PendingFile, DevicesAndFoldersAreNotReplaced) {
  TemporaryFolder folder;
  EXPECT_THAT(messageOf<RunError>([] { PendingFile("/dev/null"); }), HasSubstr("/dev/null: is not a file"));
  EXPECT_THAT(messageOf<RunError>([&] { PendingFile pending(folder.path()); }), HasSubstr("is not a file"));
}

TEST(RequireOther, AnInputIsNoOutput) {
  TemporaryFolder folder;
  const auto input = folder.write("x", "text");
  std::filesystem::create_symlink(input, folder.file("y"));
  EXPECT_THAT(messageOf<ConfigError>([&] {
                requireOther(folder.file("y"), {"", input});
              }),
              HasSubstr("another"));
  EXPECT_NO_THROW(requireOther(folder.file("z"), {input}));
}

TEST(WriteFileAtomically, ReplacesFilesAndWhatLinksPointTo) {
  TemporaryFolder folder;
  folder.write("target", "old");
  std::filesystem::create_symlink("target", folder.file("link"));
  writeFileAtomically(folder.file("link"), "new");
  EXPECT_EQ(folder.read("target"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(folder.count(), 2u);
}

TEST(WriteFileAtomically, WritesToWhatIsNoFile) {
  EXPECT_THAT(messageOf<RunError>([] { writeFileAtomically("/dev/full", "text"); }),
              HasSubstr("/dev/full: No space left on device"));
  EXPECT_NO_THROW(writeFileAtomically("/dev/null", "text"));
}

}  // namespace
}  // namespace roomgraph
