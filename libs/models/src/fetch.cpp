// SPDX-License-Identifier: BSD-3-Clause
// Files of a network one by one: found, fetched, verified and put into place under the folder's lock.
#include "roomgraph/models/fetch.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <vector>

#include "download.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/models/model_folder.h"
#include "source_places.h"

namespace roomgraph {
namespace {

namespace fs = std::filesystem;

/// The folder of a network, made if need be, locked against other processes; removed at the end if it is
/// empty.
class LockedFolder {
 public:
  LockedFolder(const fs::path& folder, const std::string& network) : folder_(folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw RunError(folder.string() + ": cannot be made: " + error.message());
    lock_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    close(lock_);
    throw RunError(network + ": another process is fetching it");
  }
  ~LockedFolder() {
    std::error_code ignored;
    fs::remove(folder_, ignored);  // not when it holds something
    if (lock_ >= 0) close(lock_);
  }
  LockedFolder(const LockedFolder&) = delete;
  LockedFolder& operator=(const LockedFolder&) = delete;

 private:
  fs::path folder_;
  int lock_ = -1;
};

// Returns false when there is no such file.
bool copy(const fs::path& source, const KnownFile& file, PartialFile& partial, FetchListener& listener) {
  std::error_code error;
  if (!fs::exists(source, error)) return false;
  std::ifstream in(source, std::ios::binary);
  const auto bytes = fs::file_size(source, error);
  if (!in || error) throw InputError(source.string() + ": cannot be read");
  if (bytes != file.bytes)
    throw RunError(source.string() + ": has " + std::to_string(bytes) + " bytes instead of the " +
                   std::to_string(file.bytes) + " of the catalogue");
  partial.clear();
  std::vector<char> block(1 << 20);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    if (listener.cancelled()) throw Interrupted(source.string() + ": interrupted while it was copied");
    partial.append({block.data(), static_cast<std::size_t>(in.gcount())});
    listener.progressed(partial.bytes());
  }
  if (!in.eof()) throw InputError(source.string() + ": cannot be read");
  return true;
}

// Returns the place it came from: the first that gives it. One that refuses is told of where no other has it.
std::string obtain(const std::vector<std::string>& places, const KnownFile& file, PartialFile& partial,
                   FetchListener& listener) {
  std::string refused;
  for (const auto& place : places) {
    if (listener.cancelled()) throw Interrupted(place + ": interrupted");
    try {
      const bool there =
          isAddress(place) ? download(place, file, partial, listener) : copy(place, file, partial, listener);
      if (there) return place;
    } catch (const Refused& error) {
      if (refused.empty()) refused = error.what();
    }
  }
  if (!refused.empty()) throw InputError(refused);
  throw InputError(file.name + ": there is no such file: " + join(places));
}

bool isThere(const KnownFile& file, const fs::path& place) {
  std::error_code error;
  return fs::is_regular_file(place, error) && fs::file_size(place, error) == file.bytes &&
         sha256OfFile(place) == file.sha256;
}

void fetchFile(const KnownNetwork& network, const KnownFile& file, const fs::path& place,
               const std::string& from, FetchListener& listener) {
  const auto places = file.content.empty() ? placesOf(network, file, from) : std::vector<std::string>();
  listener.started(file);
  PartialFile partial(place);
  std::string source = "the catalogue";
  if (file.content.empty()) {
    source = obtain(places, file, partial, listener);
  } else {
    partial.clear();
    partial.append(file.content);
  }
  const std::string sum = sha256OfFile(partial.path());
  if (sum != file.sha256) {
    partial.clear();
    throw RunError(source + ": has the SHA-256 " + sum + " instead of " + file.sha256 +
                   ": damaged on the way, or another file; nothing was kept");
  }
  partial.commit();
  listener.finished(file, false);
}

}  // namespace

void fetchNetwork(const KnownNetwork& network, const fs::path& models, const std::string& from,
                  FetchListener& listener) {
  const fs::path folder = folderOf(network, models);
  for (const auto& file : network.files)  // what cannot be fetched leaves no folders
    if (file.content.empty() && !isThere(file, folder / file.name)) (void)placesOf(network, file, from);
  const LockedFolder lock(folder, network.name);
  for (const auto& file : network.files) {
    if (isThere(file, folder / file.name))
      listener.finished(file, true);
    else
      fetchFile(network, file, folder / file.name, from, listener);
  }
}

}  // namespace roomgraph
