// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

#include <mrpt/obs/CRawlog.h>

#include <filesystem>
#include <string>

namespace roomgraph {

/// Folder of a rawlog's external images: MRPT's rule, also for "x.rawlog.gz".
inline std::string imageFolderOf(std::filesystem::path file) {
  if (file.extension() == ".gz") file.replace_extension();
  return mrpt::obs::CRawlog::detectImagesDirectory(std::filesystem::absolute(file).string());
}

}  // namespace roomgraph
