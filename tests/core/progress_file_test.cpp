// SPDX-License-Identifier: BSD-3-Clause
// Progress in a file and what a watcher reads.
#include "roomgraph/core/progress_file.h"

#include <gtest/gtest.h>

#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

TEST(ProgressInAFile, IsWhatAWatcherReads) {
  const TemporaryFolder folder;
  const auto file = folder.file("progress");
  EXPECT_FALSE(readProgress(file));
  ProgressFile progress(file);
  EXPECT_EQ(readProgress(file), 0.0);
  progress.update(0.43219);
  EXPECT_EQ(readProgress(file), 0.4322);
  progress.update(0.9);
  EXPECT_EQ(readProgress(file), 0.4322) << "too soon";
}

TEST(ProgressInAFile, IsNeverAnError) {
  ProgressFile none(""), impossible("/nowhere/progress"), device("/dev/full");
  none.update(0.5);
  impossible.update(0.5);
  device.update(0.5);
  const TemporaryFolder folder;
  EXPECT_FALSE(readProgress(folder.write("odd", "almost")));
  EXPECT_FALSE(readProgress(folder.write("odd", "17")));
}

}  // namespace
}  // namespace roomgraph::test
