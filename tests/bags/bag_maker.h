// SPDX-License-Identifier: BSD-3-Clause
// Test bags by the Python writers beside this file, and imports of them.
#pragma once

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "rawlog_records.h"
#include "roomgraph/bags/bag_import.h"
#include "temporary_folder.h"

namespace roomgraph::test {

inline constexpr double kStart_s = 1700000000;

/// Runs a script of this folder with Debian's Python, which has Debian's rosbag.
inline void runPython(const std::string& script, const std::string& arguments) {
  const std::string command = "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 '" ROOMGRAPH_SOURCE_DIR
                              "/tests/bags/" +
                              script + "' " + arguments;
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// A bag of bag_content.py; `json`: its options.
inline std::filesystem::path makeBag(const TemporaryFolder& folder, const std::string& json = "{}",
                                     const std::string& name = "x.bag") {
  runPython("write_bag.py", "'" + folder.file(name).string() + "' '" + json + "'");
  return folder.file(name);
}

/// A bag with these options, imported.
struct Imported {
  explicit Imported(const std::string& json, const BagImportOptions& options = {}) {
    result = importBag(makeBag(folder, json, json.find("ros2") == std::string::npos ? "x.bag" : "x.db3"),
                       folder.file("x.rawlog"), options);
    records = recordsIn(folder.file("x.rawlog"));
  }
  TemporaryFolder folder;
  BagImportResult result;
  std::vector<mrpt::obs::CObservation::Ptr> records;
};

}  // namespace roomgraph::test
