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

/// Light on the matter of a mesh (scene/shading.hpp). It is applied to segments after they are integrated, with the
/// normal of their tet. This file computes it in double precision, lattice/lattice_lights-inl.h for the lattice.
namespace tessera::projection {

/// The normals of the tets of segments, indexed by the tet number in the segment. A normal has length 1, or 0 where the
/// field has no gradient. Normals are floats, so that those computed locally and those received from another process
/// are the same.
class CellNormals {
 public:
  CellNormals() = default;
  CellNormals(const CellNormals&) = delete;
  CellNormals& operator=(const CellNormals&) = delete;
  virtual ~CellNormals() = default;
  [[nodiscard]] virtual glm::vec3 of(std::uint32_t tet) const = 0;
};

/// Computes the normals of a mesh in memory on demand. The bits do not depend on which part of a mesh contains the tet.
class MeshNormals final : public CellNormals {
 public:
  explicit MeshNormals(const scene::TetMeshView& mesh) : mesh_(mesh) {}
  [[nodiscard]] glm::vec3 of(std::uint32_t tet) const override;

 private:
  scene::TetMeshView mesh_;
};

/// Stores the normals of segments from another process.
class SentNormals final : public CellNormals {
 public:
  [[nodiscard]] glm::vec3 of(std::uint32_t tet) const override {
    const auto found = normals_.find(tet);
    return found == normals_.end() ? glm::vec3(0) : found->second;
  }
  void set(std::uint32_t tet, const glm::vec3& normal) { normals_.insert_or_assign(tet, normal); }
  /// Removes the normals of tets that have no segments in `left`, once enough normals have accumulated.
  void forget(const RaySegments& left);

 private:
  std::unordered_map<std::uint32_t, glm::vec3> normals_;
  std::size_t kept_ = 0;  ///< number of normals after the last removal
};

/// Returns the function with every color replaced by an upper bound of the lit color.
scene::TransferFunction brightest(const scene::Shading& shading, const scene::TransferFunction& function);

/// The lighting of a frame.
class MatterLight {
 public:
  MatterLight(const scene::Shading& shading, const scene::Camera& camera);

  /// A segment's colour c becomes own * c + white.
  struct Light {
    double own = 1, white = 0;
  };
  /// Returns the light on matter with this normal. `ray` points away from the eye, and may have any length.
  [[nodiscard]] Light on(const glm::vec3& normal, const glm::dvec3& ray) const;
  /// An upper bound of lit colours, for unlit colours up to `color`.
  [[nodiscard]] double brightest(double color) const;
  [[nodiscard]] const scene::Shading& shading() const { return shading_; }
  [[nodiscard]] const glm::dvec3& to_light() const { return to_light_; }  ///< world space, of length 1
  /// The shininess if it is a whole number; otherwise -1.
  [[nodiscard]] int whole_shininess() const { return whole_shininess_; }
  /// A halfway vector shorter than this has no direction: the light is straight behind the scene.
  static constexpr double nothing = 1e-12;

 private:
  scene::Shading shading_;
  glm::dvec3 to_light_;  ///< world space, of length 1
  int whole_shininess_ = -1;
};

}  // namespace tessera::projection
