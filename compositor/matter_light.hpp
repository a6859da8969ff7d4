// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>

#include "projection/ray_segments.hpp"
#include "scene/camera.hpp"
#include "scene/shading.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"

/// Light on the matter of a mesh (scene/shading.hpp): segments get it after they are integrated, by the normal of their
/// tet. Neither stores nor sorting know of it; in double precision alone.
namespace tessera::compositor {

/// The normals of the tets that segments are of, by the number that segments have: of length one, 0 where the field has
/// no gradient. Floats, so that they are the same wherever they come from.
class CellNormals {
 public:
  CellNormals() = default;
  CellNormals(const CellNormals&) = delete;
  CellNormals& operator=(const CellNormals&) = delete;
  virtual ~CellNormals() = default;
  [[nodiscard]] virtual glm::vec3 of(std::uint32_t tet) const = 0;
};

/// Of a mesh at hand, computed when they are asked for. The same bits whatever part of a mesh has the tet.
class MeshNormals final : public CellNormals {
 public:
  explicit MeshNormals(const scene::TetMeshView& mesh) : mesh_(mesh) {}
  [[nodiscard]] glm::vec3 of(std::uint32_t tet) const override;

 private:
  scene::TetMeshView mesh_;
};

/// Of segments that another process has sent.
class SentNormals final : public CellNormals {
 public:
  [[nodiscard]] glm::vec3 of(std::uint32_t tet) const override {
    const auto found = normals_.find(tet);
    return found == normals_.end() ? glm::vec3(0) : found->second;
  }
  void set(std::uint32_t tet, const glm::vec3& normal) { normals_.insert_or_assign(tet, normal); }
  /// Now and then forgets the tets of which no segment is left.
  void forget(const projection::RaySegments& left);

 private:
  std::unordered_map<std::uint32_t, glm::vec3> normals_;
  std::size_t kept_ = 0;  ///< when it last forgot
};

/// The light of a frame.
class MatterLight {
 public:
  MatterLight(const scene::Shading& shading, const scene::Camera& camera);

  /// What becomes of a segment's colour c: own * c + white.
  struct Light {
    double own = 1, white = 0;
  };
  /// `ray`: away from the eye, of any length.
  [[nodiscard]] Light on(const glm::vec3& normal, const glm::dvec3& ray) const;
  /// No colour up to `color` becomes brighter.
  [[nodiscard]] double brightest(double color) const;
  /// The function with every colour as bright as it may become.
  [[nodiscard]] scene::TransferFunction brightest(const scene::TransferFunction& function) const;

 private:
  scene::Shading shading_;
  glm::dvec3 to_light_;  ///< world, of length one
  int whole_shininess_ = -1;
};

}  // namespace tessera::compositor
