// SPDX-License-Identifier: BSD-3-Clause
// Network formats and files: label lists, Darknet configuration, input size.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "network.h"

namespace roomgraph {

std::string toString(NetworkFormat format);
/// "nanodet, yolox, …" as a user may write them.
std::string knownFormats();
std::string firstLine(const std::string& text);
/// "1x3598x112, …".
std::string describeShape(const std::vector<cv::Mat>& blobs);

/// Throws InputError when there is no such file; `what` names its role.
void requireFile(const std::string& file, const std::string& what);
/// One label per line. Throws InputError when the file is missing or empty.
std::vector<std::string> readLabels(const std::string& file);
/// width and height of a Darknet .cfg's [net] section. Throws InputError.
cv::Size darknetInputSize(const std::string& file);
/// The last number in a file's name that may be an input size (a multiple of 32 in [128, 2048]); 0 when there
/// is none.
int sizeFromName(const std::string& file);

}  // namespace roomgraph
