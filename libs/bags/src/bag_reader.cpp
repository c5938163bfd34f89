// SPDX-License-Identifier: BSD-3-Clause
// Kind of a bag by its first bytes, and the files of a ROS 2 folder.
#include "bag_reader.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>

#include "mcap_bag.h"
#include "roomgraph/core/errors.h"
#include "ros1_bag.h"
#include "ros2_bag.h"

namespace roomgraph::bags {
namespace {

namespace fs = std::filesystem;

const char* const kConvert =
    "; `ros2 bag convert` with storage_id sqlite3 and no compression makes one that can be read";

std::string beginningOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": " + (fs::exists(file) ? "cannot be opened" : "no such file"));
  std::string text(16, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return text;
}

enum class BagKind { kRos1, kSqlite, kMcap };

BagKind kindOf(const fs::path& file) {
  const std::string text = beginningOf(file);
  if (text.empty()) throw InputError(file.string() + ": is empty");
  if (text.starts_with("#ROSBAG V")) return BagKind::kRos1;
  if (text.starts_with("SQLite format 3")) return BagKind::kSqlite;
  if (text.starts_with("\x89MCAP")) return BagKind::kMcap;
  if (text.starts_with("\x28\xb5\x2f\xfd"))
    throw InputError(file.string() + ": is compressed (zstd)" + kConvert);
  throw InputError(file.string() + ": is no bag, neither of ROS 1 (.bag) nor of ROS 2 (.db3, .mcap)");
}

// "x_10.db3" comes behind "x_9.db3".
std::pair<long, std::string> placeOf(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto bar = stem.rfind('_');
  long number = 0;
  if (bar != stem.npos) std::from_chars(stem.data() + bar + 1, stem.data() + stem.size(), number);
  return {number, stem};
}

std::vector<fs::path> filesIn(const fs::path& folder) {
  std::map<std::string, std::vector<fs::path>> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) found[entry.path().extension().string()].push_back(entry.path());
  for (const char* extension : {".db3", ".mcap", ".zstd"}) {
    auto& files = found[extension];
    std::sort(files.begin(), files.end(),
              [](const auto& a, const auto& b) { return placeOf(a) < placeOf(b); });
    if (!files.empty()) return files;  // of one that cannot be read, its own error says more
  }
  throw InputError(folder.string() + ": no bag in this folder (no .db3, no .mcap)");
}

}  // namespace

std::vector<fs::path> filesOfBag(const fs::path& bag) {
  if (fs::is_directory(bag)) return filesIn(bag);
  return {bag};
}

std::unique_ptr<BagReader> openBag(const fs::path& bag) {
  const auto files = filesOfBag(bag);
  const BagKind kind = kindOf(files.front());
  for (const auto& file : files)
    if (kindOf(file) != kind)
      throw InputError(file.string() + ": is of another kind than " + files.front().string());
  if (kind == BagKind::kRos1) return openRos1Bag(files.front());
  return kind == BagKind::kMcap ? openMcapBag(files) : openRos2Bag(files);
}

}  // namespace roomgraph::bags
