// SPDX-License-Identifier: BSD-3-Clause
// How many objects of each class a picture shows, in words of its legend.
#pragma once

#include <map>
#include <string>

#include "map_picture.h"

namespace roomgraph {

struct ClassCount {
  int shown = 0, whole = 0;  ///< in the part that the picture shows, and in the whole map
};

/// By class, of all that are in the whole map.
std::map<std::string, ClassCount> classCounts(const MapPicture& picture);

/// "swivel chair (3)".
std::string withCount(const std::string& class_name, int count);

}  // namespace roomgraph
