// SPDX-License-Identifier: BSD-3-Clause
// The list of targets, and files for readers that want a path.
#include "target.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>

#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::fuzz {
namespace {

std::vector<Target>& registered() {
  static std::vector<Target> all;
  return all;
}

// Faster than a stream, and the largest part of the time of a small text.
void writeBytes(const std::filesystem::path& file, std::string_view bytes) {
  const int out = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  require(out >= 0 && write(out, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
          "the scratch folder can be written");
  close(out);
}

}  // namespace

TargetRegistration::TargetRegistration(const char* name, ReadBytes read) {
  auto& all = registered();
  const auto by_name = [](const Target& a, const Target& b) { return a.name < b.name; };
  const Target added{name, read};
  all.insert(std::lower_bound(all.begin(), all.end(), added, by_name), added);
}

const std::vector<Target>& targets() {
  return registered();
}

const Target* findTarget(std::string_view name) {
  const auto& all = targets();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Target& t) { return t.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string readWith(const Target& target, std::string_view bytes) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    target.read(bytes);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

const std::filesystem::path& scratchFolder() {
  static const test::TemporaryFolder folder;
  return folder.path();
}

std::filesystem::path scratchFile(const std::string& name, std::string_view bytes) {
  const auto file = scratchFolder() / name;
  writeBytes(file, bytes);
  return file;
}

void writeParts(std::string_view bytes, const std::vector<std::string>& names) {
  bool left = true;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!left) {
      std::filesystem::remove(scratchFolder() / names[i]);
      continue;
    }
    const auto mark = i + 1 < names.size() ? bytes.find(kPartMark) : std::string_view::npos;
    scratchFile(names[i], bytes.substr(0, mark));
    left = mark != std::string_view::npos;
    if (left) bytes.remove_prefix(mark + kPartMark.size());
  }
}

void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "this does not hold: %s\n", promise);
  std::abort();
}

}  // namespace roomgraph::fuzz
