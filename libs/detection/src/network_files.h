// SPDX-License-Identifier: BSD-3-Clause
// What the user says about a network, and the files beside it: labels, Darknet configuration.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace roomgraph {

/// One network as configured by the user.
struct NetworkSpec {
  std::string file;         ///< .onnx, or Darknet .weights with a .cfg of the same name beside it
  std::string format;       ///< name of a NetworkDecoder; empty: the one that recognises the output
  std::string labels_file;  ///< empty: labels.txt beside the file, or a known list
  int input_size_px = 0;    ///< 0: from the .cfg, the file's name, or by trying
  double rate_hz = 0;       ///< frames a second on which it runs at most; 0: every one on which the detector runs
};

/// Splits "path[:format][@rate]". Throws ConfigError that lists the known formats.
NetworkSpec parseNetworkSpec(const std::string& text);

/// Up to the first line break.
std::string firstLine(const std::string& text);
/// Sizes of the blobs, as in "1x3598x112, 1x85".
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
