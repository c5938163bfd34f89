// SPDX-License-Identifier: BSD-3-Clause
// Fetching of a network from its authors, a mirror or a folder into the model folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "roomgraph/models/catalogue.h"

namespace roomgraph {

/// Told of the progress; asked whether to go on.
class FetchListener {
 public:
  virtual ~FetchListener() = default;
  /// Before a file is fetched.
  virtual void started(const KnownFile& file) { (void)file; }
  /// So many bytes of it are there, those of a former attempt included.
  virtual void progressed(std::uint64_t bytes) { (void)bytes; }
  /// It is in its place. `was_there`: it had been before.
  virtual void finished(const KnownFile& file, bool was_there) { (void)file, (void)was_there; }
  virtual bool cancelled() const { return false; }
};

/// Puts the files of a network into its folder, those that are there in full left alone. Each is written as
/// NAME.part, which a later call continues, and gets its name when its checksum is right. `from`: a folder,
/// or the address (http, https) of one, with the files in it or in a sub-folder of the network's; empty: the
/// published addresses. Proxies are those of the environment. Throws ConfigError: `from` is needed, or no
/// such address; InputError: the source cannot be reached or read, or ended too early; RunError: wrong
/// checksum, the folder cannot be written, or another process is fetching this network; Interrupted:
/// cancelled by the listener.
void fetchNetwork(const KnownNetwork& network, const std::filesystem::path& models, const std::string& from,
                  FetchListener& listener);

}  // namespace roomgraph
