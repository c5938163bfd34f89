// SPDX-License-Identifier: BSD-3-Clause
// Triangles and textures taken from an assimp model, axes converted.
#include "mesh_file.h"

#include <mrpt/opengl/CAssimpModel.h>
#include <mrpt/opengl/CSetOfTexturedTriangles.h>
#include <mrpt/opengl/RenderQueue.h>

#include <opencv2/core.hpp>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using mrpt::opengl::CAssimpModel;
using mrpt::opengl::CSetOfTexturedTriangles;

Eigen::Vector3f turned(float x, float y, float z) {
  return {z, x, y};
}

MeshTriangle fromMrpt(const mrpt::opengl::TTriangle& triangle, int material) {
  MeshTriangle out;
  out.material = material;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& vertex = triangle.vertices[i];
    out.position[i] = turned(vertex.xyzrgba.pt.x, vertex.xyzrgba.pt.y, vertex.xyzrgba.pt.z);
    out.normal[i] = turned(vertex.normal.x, vertex.normal.y, vertex.normal.z);
    out.uv[i] = {vertex.uv.x, vertex.uv.y};
  }
  const Eigen::Vector3f face = (out.position[1] - out.position[0]).cross(out.position[2] - out.position[0]);
  for (auto& normal : out.normal) normal = normal.norm() > 1e-6f ? normal.normalized() : face.normalized();
  return out;
}

void addPlain(const CAssimpModel& model, MaterialList& materials, Mesh& mesh) {
  for (const auto& triangle : model.shaderTrianglesBuffer()) {
    const auto& color = triangle.vertices[0].xyzrgba;
    const Material material{"plain", {color.r / 255.0, color.g / 255.0, color.b / 255.0}, 1, 0, nullptr};
    mesh.triangles.push_back(fromMrpt(triangle, materials.add(material)));
  }
}

/// The model keeps its textured pieces to itself, but names them to a renderer.
void addTextured(const CAssimpModel& model, MaterialList& materials, Mesh& mesh) {
  mrpt::opengl::RenderQueue queue;
  model.enqueueForRenderRecursive({}, queue, true);
  for (const auto& [shader, elements] : queue) {
    for (const auto& [depth, element] : elements) {
      const auto* piece = dynamic_cast<const CSetOfTexturedTriangles*>(element.object);
      if (!piece || piece->getTrianglesCount() == 0) continue;
      const cv::Mat picture = piece->getTextureImage().asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
      const int material =
          materials.add({"picture", {1, 1, 1}, 1, 0, std::make_shared<const cv::Mat>(picture)});
      for (std::size_t i = 0; i < piece->getTrianglesCount(); ++i)
        mesh.triangles.push_back(fromMrpt(piece->getTriangle(i), material));
    }
  }
}

}  // namespace

Mesh readMeshFile(const std::filesystem::path& file, MaterialList& materials) {
  Mesh mesh;
  try {
    CAssimpModel model;
    model.loadScene(file.string(),
                    CAssimpModel::LoadFlags::RealTimeQuality | CAssimpModel::LoadFlags::FlipUVs);
    model.onUpdateBuffers_all();
    addPlain(model, materials, mesh);
    addTextured(model, materials, mesh);
  } catch (const std::exception& error) {
    const std::string what = error.what();
    throw InputError(file.string() +
                     ": cannot be read as a mesh: " + what.substr(0, what.find("Call stack")));
  }
  if (mesh.triangles.empty()) throw InputError(file.string() + ": no triangles in it");
  return mesh;
}

}  // namespace roomgraph
