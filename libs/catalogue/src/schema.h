// SPDX-License-Identifier: BSD-3-Clause
// Tables of the catalogue and their version.
#pragma once

#include "database.h"

namespace roomgraph {

/// Makes the tables in a new file. Throws RunError: the file belongs to another version or program.
void makeSchema(Database& database);

/// Throws InputError: the file belongs to another version or program.
void requireSchema(const Database& database);

}  // namespace roomgraph
