// SPDX-License-Identifier: BSD-3-Clause
// Locking, publication and recovery of an output folder from its unfinished sub-folder.
#include "roomgraph/core/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <set>
#include <stdexcept>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/output_file.h"
#include "roomgraph/core/paths.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

// Ignores the signals that end a program, while files are being moved.
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

constexpr const char* kComplete = "complete";  // names what is to change places, when all is written
constexpr const char* kKeptCheckpoint = "/checkpoint";  // among them: no name of a file

void require(const std::error_code& error, const fs::path& path) {
  if (error) throw RunError("output folder " + path.string() + ": " + error.message());
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, std::vector<std::string> names,
                           const std::vector<fs::path>& inputs)
    : folder_(folder), unfinished_(folder / "roomgraph_unfinished"), names_(std::move(names)) {
  for (const auto& input : inputs) protect(input);
  std::error_code error;
  if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
    throw RunError("output folder " + folder_.string() + ": is a file");
  fs::create_directories(folder_, error);
  if (error) throw RunError("output folder " + folder_.string() + ": cannot be made: " + error.message());
  for (const auto& name : names_)
    if (fs::is_directory(folder_ / name, error))
      throw RunError("output folder " + folder_.string() + ": '" + name +
                     "' is a folder, and the name of a result; choose another output folder");
  lock();
  try {
    if (fs::exists(unfinished_ / kComplete, error)) settle();
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
  if (!fs::exists(unfinished_ / kComplete, ignored)) fs::remove_all(unfinished_, ignored);
  if (lock_ >= 0) close(lock_);
}

// Some (network) file systems cannot lock a folder; there it is not locked.
void OutputFolder::lock() {
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(lock_);
  throw RunError("output folder " + folder_.string() +
                 ": another process is writing into it; choose another one, or wait");
}

fs::path OutputFolder::pending(const std::string& name) const {
  if (std::find(names_.begin(), names_.end(), name) == names_.end())
    throw std::logic_error("output folder: '" + name + "' is not among its files");
  return unfinished_ / name;
}

void OutputFolder::protect(const fs::path& input) const {
  std::error_code none;
  const bool replaced = std::any_of(names_.begin(), names_.end(), [&](const std::string& name) {
    return fs::equivalent(input, folder_ / name, none);
  });
  if (replaced || isInside(input, unfinished_) || isInside(input, checkpoint()))
    throw ConfigError(input.string() +
                      ": is read by this run and would be replaced by its results; choose "
                      "another output folder");
}

void OutputFolder::requireInPlace() const {
  struct stat at_path {
  }, locked{};
  const bool there = stat(folder_.c_str(), &at_path) == 0 && fs::exists(unfinished_);
  const bool other = lock_ >= 0 && fstat(lock_, &locked) == 0 &&
                     (at_path.st_dev != locked.st_dev || at_path.st_ino != locked.st_ino);
  if (!there || other)
    throw RunError("output folder " + folder_.string() + ": vanished while it was written into");
}

void OutputFolder::publish(bool keep_checkpoint) {
  requireInPlace();
  std::string written = keep_checkpoint ? std::string(kKeptCheckpoint) + "\n" : "";
  for (const auto& name : names_) {
    if (!fs::exists(unfinished_ / name)) continue;
    flushToDisk(unfinished_ / name);
    written += name + "\n";
  }
  writeFileAtomically(unfinished_ / kComplete, written);
  const WithoutSignals quiet;
  settle();
}

// May be begun by one process and completed by another.
void OutputFolder::settle() {
  std::ifstream in(unfinished_ / kComplete);
  std::set<std::string> written;
  for (std::string name; std::getline(in, name);) written.insert(name);
  std::error_code error;
  if (fs::exists(unfinished_ / names_.back())) fs::remove(folder_ / names_.back(), error);
  require(error, folder_ / names_.back());
  for (const auto& name : names_) {
    if (!written.contains(name))
      fs::remove(folder_ / name, error);
    else if (fs::exists(unfinished_ / name))
      fs::rename(unfinished_ / name, folder_ / name, error);
    require(error, folder_ / name);
  }
  if (lock_ >= 0) fsync(lock_);
  if (!written.contains(kKeptCheckpoint)) fs::remove_all(checkpoint(), error);
  require(error, checkpoint());
  fs::remove_all(unfinished_, error);
}

}  // namespace roomgraph
