// SPDX-License-Identifier: BSD-3-Clause
// The object database that is shipped.
#pragma once

#include "roomgraph/observations/object_database.h"

namespace roomgraph::test {

inline const ObjectDatabase& shippedObjects() {
  static const ObjectDatabase database = ObjectDatabase::fromFile(ROOMGRAPH_SOURCE_DIR "/objects.ini");
  return database;
}

}  // namespace roomgraph::test
