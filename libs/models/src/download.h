// SPDX-License-Identifier: BSD-3-Clause
// Download of one file over HTTP into a partial file.
#pragma once

#include <string>

#include "partial_file.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/models/fetch.h"

namespace roomgraph {

/// A server that answers, but does not give this file (403, 500).
struct Refused : InputError {
  using InputError::InputError;
};

/// Fetches what the partial file lacks; begins anew when the server does not know ranges. Returns false when
/// there is no such file on the server (404, 410), the partial file being as it was. Throws InputError
/// (unreachable, broken off: what has come is kept; Refused), RunError (not of `file`'s size; cannot be
/// written), Interrupted.
bool download(const std::string& url, const KnownFile& file, PartialFile& partial, FetchListener& listener);

}  // namespace roomgraph
