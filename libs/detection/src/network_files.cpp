// SPDX-License-Identifier: BSD-3-Clause
// Parsing of network specifications, label files and Darknet .cfg files.
#include "network_files.h"

#include <charconv>
#include <filesystem>
#include <fstream>
#include <regex>

#include "network_decoders.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/core/trim.h"

namespace roomgraph {

namespace {

/// Takes "@rate" off the end of the text, Hz; an @ that no number follows is part of a name.
double cutRate(std::string& text) {
  const auto at = text.rfind('@');
  if (at == std::string::npos) return 0;
  const std::string number = trim(text.substr(at + 1));
  double rate = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), rate);
  if (error != std::errc() || end != number.data() + number.size()) return 0;
  constexpr double kMost_hz = 1000;
  if (!(rate > 0 && rate <= kMost_hz))
    throw ConfigError("[detection] models: '" + text + "': a rate is a number in (0, 1000], Hz");
  text = trim(text.substr(0, at));
  return rate;
}

}  // namespace

NetworkSpec parseNetworkSpec(const std::string& whole) {
  NetworkSpec spec;
  std::string text = whole;
  spec.rate_hz = cutRate(text);
  spec.file = text;
  const auto colon = text.rfind(':');
  if (colon == std::string::npos || text.find_first_of("/.", colon) != std::string::npos) return spec;
  spec.file = trim(text.substr(0, colon));
  const std::string wanted = trim(text.substr(colon + 1));
  if (wanted == "auto") return spec;
  spec.format = wanted;
  if (decoderNamed(wanted)) return spec;
  throw ConfigError("[detection] models: '" + text + "': unknown format '" + wanted +
                    "'; known: " + knownFormats());
}

std::string firstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

std::string describeShape(const std::vector<cv::Mat>& blobs) {
  std::vector<std::string> shapes;
  for (const cv::Mat& blob : blobs) {
    std::vector<std::string> sizes;
    for (int i = 0; i < blob.dims; ++i) sizes.push_back(std::to_string(blob.size[i]));
    shapes.push_back(join(sizes, "x"));
  }
  return join(shapes);
}

void requireFile(const std::string& file, const std::string& what) {
  if (!std::filesystem::is_regular_file(file)) throw InputError(file + ": no such " + what + " file");
}

std::vector<std::string> readLabels(const std::string& file) {
  requireFile(file, "label");
  std::ifstream in(file);
  std::vector<std::string> labels;
  for (std::string line; std::getline(in, line);)
    if (const std::string label = trim(line); !label.empty()) labels.push_back(label);
  if (labels.empty()) throw InputError(file + ": holds no labels (one per line)");
  return labels;
}

cv::Size darknetInputSize(const std::string& file) {
  std::ifstream in(file);
  cv::Size size;
  int sections = 0;
  for (std::string line; std::getline(in, line) && sections < 2;) {
    if (!line.empty() && line.front() == '[') ++sections;
    const auto equals = line.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = trim(line.substr(0, equals)), value = trim(line.substr(equals + 1));
    constexpr std::size_t kMostDigits = 5;
    const bool number = !value.empty() && value.size() <= kMostDigits &&
                        value.find_first_not_of("0123456789") == std::string::npos;
    if (number && (key == "width" || key == "height"))
      (key == "width" ? size.width : size.height) = std::stoi(value);
  }
  if (size.empty()) throw InputError(file + ": [net] gives no width and height");
  return size;
}

int sizeFromName(const std::string& file) {
  const std::string name = std::filesystem::path(file).stem().string();
  static const std::regex number(R"(\d+)");
  int found = 0;
  for (std::sregex_iterator it(name.begin(), name.end(), number), end; it != end; ++it) {
    if (it->length() > 4) continue;
    const int value = std::stoi(it->str());
    if (value >= 128 && value <= 2048 && value % 32 == 0) found = value;
  }
  return found;
}

}  // namespace roomgraph
