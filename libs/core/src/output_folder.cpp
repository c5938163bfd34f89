// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/core/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <stdexcept>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

// For the moment in which files change places.
class WithoutSignals {
 public:
  WithoutSignals() {
    for (std::size_t i = 0; i < std::size(kSignals); ++i) former_[i] = std::signal(kSignals[i], SIG_IGN);
  }
  ~WithoutSignals() {
    for (std::size_t i = 0; i < std::size(kSignals); ++i) std::signal(kSignals[i], former_[i]);
  }

 private:
  static constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
  void (*former_[std::size(kSignals)])(int);
};

void require(const std::error_code& error, const fs::path& path) {
  if (error) throw RunError("output folder " + path.string() + ": " + error.message());
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, std::vector<std::string> names)
    : folder_(folder), unfinished_(folder / "roomgraph_unfinished"), names_(std::move(names)) {
  std::error_code error;
  if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
    throw RunError("output folder " + folder_.string() + ": is a file");
  fs::create_directories(folder_, error);
  if (error) throw RunError("output folder " + folder_.string() + ": cannot be made: " + error.message());
  for (const auto& name : names_)
    if (fs::is_directory(folder_ / name, error))
      throw RunError("output folder " + folder_.string() + ": '" + name +
                     "' is a folder, and the name of a result; choose another output folder");
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // File systems that cannot lock a folder (some of the network) go without.
  if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(lock_);
    throw RunError("output folder " + folder_.string() +
                   ": another process is writing into it; choose another one, or wait");
  }
  try {
    fs::remove_all(unfinished_, error);
    require(error, unfinished_);
    fs::create_directory(unfinished_, error);
    require(error, unfinished_);
  } catch (const RunError&) {
    close(lock_);
    throw;
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(unfinished_, ignored);
  if (lock_ >= 0) close(lock_);
}

fs::path OutputFolder::pending(const std::string& name) const {
  if (std::find(names_.begin(), names_.end(), name) == names_.end())
    throw std::logic_error("output folder: '" + name + "' is not among its files");
  return unfinished_ / name;
}

void OutputFolder::protect(const fs::path& input) const {
  std::error_code ignored;
  for (const auto& name : names_)
    if (fs::equivalent(input, folder_ / name, ignored))
      throw ConfigError(input.string() +
                        ": is read by this run and would be replaced by its results; choose "
                        "another output folder");
}

void OutputFolder::publish() {
  std::error_code error;
  const auto written = [&](const std::string& name) { return fs::exists(unfinished_ / name); };
  for (const auto& name : names_)
    if (written(name)) flushToDisk(unfinished_ / name);
  const WithoutSignals quiet;
  fs::remove(folder_ / names_.back(), error);
  require(error, folder_ / names_.back());
  for (const auto& name : names_) {
    if (written(name))
      fs::rename(unfinished_ / name, folder_ / name, error);
    else
      fs::remove(folder_ / name, error);
    require(error, folder_ / name);
  }
  fs::remove_all(unfinished_, error);
}

}  // namespace roomgraph
