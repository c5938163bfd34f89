// SPDX-License-Identifier: BSD-3-Clause
// OpenGL scene of a semantic map.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include "roomgraph/observations/CSemanticMap.h"
#include "roomgraph/observations/object_database.h"

namespace roomgraph {

/// The map as a scene in world: floor (unknown, free, occupied), low walls, a grid of whole metres, objects
/// in their class's colour with an arrow towards the front, the path from light to dark with start and end.
/// Needs no display; can be shown, rendered, or saved as .3Dscene.
mrpt::opengl::COpenGLScene::Ptr buildScene(const CSemanticMap& map, const ObjectDatabase& database);

}  // namespace roomgraph
