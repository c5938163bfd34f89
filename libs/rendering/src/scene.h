// SPDX-License-Identifier: BSD-3-Clause
// OpenGL scene of a semantic map.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include "map_picture.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// The map as a scene in world: floor (unknown, free, occupied), low walls, a grid of whole metres, objects
/// in their class's colour with an arrow towards the front, the path from light to dark with start and end.
/// In a film also lines of sight. Needs no display; can be shown, rendered, or saved as .3Dscene.
mrpt::opengl::COpenGLScene::Ptr buildScene(const MapPicture& picture, const ObjectDatabase& database);

}  // namespace roomgraph
