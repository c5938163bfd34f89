// SPDX-License-Identifier: BSD-3-Clause
// Mesh files with materials, read through MRPT's assimp model.
#pragma once

#include <filesystem>

#include "roomgraph/simulation/mesh.h"

namespace roomgraph {

/// Reads a mesh file (OBJ with materials and textures, or what else MRPT's assimp model reads). Files have y
/// up and z to the front, as furniture catalogues do; the mesh has x to the front and z up, in the file's
/// units. Throws InputError when it cannot be read.
Mesh readMeshFile(const std::filesystem::path& file, MaterialList& materials);

}  // namespace roomgraph
