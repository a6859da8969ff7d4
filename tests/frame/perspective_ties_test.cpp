// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "datasets/boxes.hpp"
#include "frame/mesh/render.hpp"
#include "reference/reference.hpp"
#include "support/some_cases.hpp"

/// The tie rule in perspective (docs/ACCURACY.md), checked against its definition: a ray in a face, along an edge or
/// through a vertex belongs to the cells of the ray shifted by (e, e^2) pixel. So an image is the limit of images of
/// the scene shifted by less and less. This is checked for the renderer and for the reference independently.
namespace tessera::frame::perspective_ties_test {
namespace {

using scene::Camera;
using scene::ImageSize;
using scene::TetMesh;

/// A perspective camera, and world points computed from pixel positions, with the usual rounding.
struct View {
  Camera camera;
  ImageSize size;
  scene::ViewBasis basis;
  double per_tangent;

  View(const glm::dvec3& eye, const glm::dvec3& focal_point, const glm::dvec3& up, double angle, ImageSize image)
      : size(image) {
    camera.position = eye;
    camera.focal_point = focal_point;
    camera.view_up = up;
    camera.projection = scene::ProjectionKind::perspective;
    camera.view_angle = angle;
    basis = scene::view_basis(camera);
    per_tangent = 0.5 * size.height / std::tan(angle * (std::numbers::pi / 360));
  }

  /// The vector from the eye to a pixel position, per unit of depth.
  [[nodiscard]] glm::dvec3 towards(double x, double y) const {
    return basis.forward + basis.right * ((x - 0.5 * size.width) / per_tangent) +
           basis.up * ((0.5 * size.height - y) / per_tangent);
  }

  /// The mesh moved so that it appears `shift` pixels further left and `shift` / 1000 pixels further up. (The edges of
  /// these tests are not so steep that shift^2 would be needed.)
  [[nodiscard]] TetMesh shifted(TetMesh mesh, double shift) const {
    for (glm::dvec3& p : mesh.positions) {
      const double part = shift * glm::dot(basis.forward, p - camera.position) / per_tangent;
      p += basis.right * -part + basis.up * (1e-3 * part);
    }
    return mesh;
  }
};

using Picture = std::vector<double>;  // RGBA
using Method = std::function<Picture(const TetMesh&, const View&)>;

scene::TransferFunction function() {
  return scene::TransferFunction({{0, {1, 0, 0.1}, 0.6}, {0.5, {0.1, 1, 0}, 0.1}, {1, {0, 0.2, 1}, 1.5}});
}

Method renderer(bool lattice) {
  return [lattice](const TetMesh& mesh, const View& view) {
    Settings settings;
    settings.integrator.kind = scene::IntegratorKind::exact;
    settings.use.lattice = lattice;
    settings.threads = 1;
    const scene::Image image = Renderer(mesh, settings).render(view.camera, view.size, function());
    return Picture(image.rgba.begin(), image.rgba.end());
  };
}

Picture of_reference(const TetMesh& mesh, const View& view) {
  Picture picture;
  for (const reference::Pixel& p : reference::Reference(mesh, view.camera, view.size, function()).image(1))
    picture.insert(picture.end(), {p.r, p.g, p.b, p.a});
  return picture;
}

double difference(const Picture& a, const Picture& b, std::size_t pixel) {
  double most = 0;
  for (std::size_t i = 4 * pixel; i < 4 * pixel + 4; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

constexpr double visible = 1e-2;

/// Expects, for each method, that the image is the limit of the images of the shifted mesh. Returns the number of
/// pixels that the rule decides: those where the opposite shift gives another result.
int expect_the_limit(const TetMesh& mesh, const View& view) {
  int decided = 0;
  for (const auto& [name, picture] : {std::pair<const char*, Method>{"lattice", renderer(true)},
                                      {"double precision", renderer(false)},
                                      {"reference", of_reference}}) {
    const Picture at = picture(mesh, view), near = picture(view.shifted(mesh, 1e-4), view),
                  far = picture(view.shifted(mesh, 1e-3), view), other = picture(view.shifted(mesh, -1e-4), view);
    int wrong = 0;
    decided = 0;
    for (std::size_t pixel = 0; pixel < at.size() / 4; ++pixel) {
      // A shift that is ten times as large changes the result ten times as much, unless a distant edge is in between.
      const double change = difference(far, near, pixel);
      if (change > visible) continue;
      wrong += difference(at, near, pixel) > 1e-5 + change;
      decided += difference(other, near, pixel) > visible;
    }
    EXPECT_EQ(wrong, 0) << name << ", of " << decided;
  }
  return decided;
}

/// A box of voxels, each divided into six tets. It begins at `corner`; `u`, `v` and `w` are the edges of a voxel. Cell
/// data are random, or constant.
TetMesh box(const std::array<int, 3>& voxels, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
            const glm::dvec3& w, bool constant = false) {
  TetMesh mesh = datasets::regular_split(voxels[0], voxels[1], voxels[2], glm::dvec3(1));
  for (glm::dvec3& p : mesh.positions) p = corner + p.x * u + p.y * v + p.z * w;
  mesh.association = scene::Association::cell;
  mesh.scalars.assign(mesh.tets.size(), 1);
  std::mt19937 random(3);
  if (!constant)
    for (double& s : mesh.scalars) s = std::uniform_real_distribution<double>()(random);
  return mesh;
}

/// Cameras of all kinds: along axes, level, tilted; far, near, with long and wide lenses.
std::vector<View> views() {
  const ImageSize even{32, 24}, odd{21, 17};
  return {{{0.1, 0.2, 5}, {0.1, 0.2, 0}, {0, 1, 0}, 30, even},
          {{0, 0, 0}, {-1, 0, 0}, {0, 0, 1}, 60, odd},
          {{0.3, -0.7, 1.1}, {1, 0, -1}, {0, 1, 0}, 30, even},
          {{1.3, 0.4, -0.9}, {std::cos(0.7) + 1.3, 0.4, std::sin(0.7) - 0.9}, {0, 1, 0}, 45, odd},
          {{1, 2, 3}, {-0.2, 0.3, 0.1}, {0, 1, 0}, 25, even},
          {{-2.3, 1.7, 0.6}, {0.4, 0.1, -0.3}, {0.3, 0.8, 0.5}, 75, odd},
          {{0.7, 0.1, -2.9}, {0.1, 0.9, 0.2}, {-0.4, 1, 0.1}, 140, even},
          {{3, -1, 2}, {0.3, 0.2, -0.1}, {0.1, 0.9, 0.4}, 0.5, odd},
          {{0.6, 1.1, 2.2}, {-0.3, -0.4, -0.8}, {0.9, 0.1, 0.2}, 10, {64, 64}}};
}

/// The plane through the eye and a column or row of pixel centres: two directions in the plane, and one across it, to
/// the right or down.
struct SightPlane {
  glm::dvec3 along, into, across;
  SightPlane(const View& view, bool column, int number) {
    const double centre = number + 0.5;
    into = glm::normalize(column ? view.towards(centre, 0.5 * view.size.height)
                                 : view.towards(0.5 * view.size.width, centre));
    along = column ? view.basis.up : view.basis.right;
    across = column ? view.basis.right : -view.basis.up;
    across = glm::normalize(across - into * glm::dot(across, into));
  }
};

TEST(PerspectiveTies, BoxesWithASideInARayPlaneAreTheLimitOfShiftedBoxes) {
  int decided = 0, scenes = 0;
  for (const View& view : views())
    for (const bool column : {true, false})
      for (const double side : {1.0, -1.0})
        for (const double turn : {0.0, 0.4}) {
          SCOPED_TRACE("scene " + std::to_string(scenes++));
          const SightPlane plane(view, column, (column ? view.size.width : view.size.height) / 2 + (turn > 0 ? 3 : -2));
          const double tangent = 0.5 * view.size.height / view.per_tangent, distance = 3 / tangent;
          const glm::dvec3 u = plane.along * std::cos(turn) + plane.into * std::sin(turn),
                           v = plane.into * std::cos(turn) - plane.along * std::sin(turn);
          const glm::dvec3 corner = view.camera.position + plane.into * distance - u * 0.7 - v * 0.4;
          const TetMesh mesh = box({1, 1, 1}, corner, 1.4 * u, 0.8 * v, plane.across * side, true);
          decided += expect_the_limit(mesh, view);
        }
  EXPECT_EQ(scenes, 72);
  EXPECT_GT(decided, 100);
}

TEST(PerspectiveTies, LatticesWithCellDataAreTheLimitOfShiftedLattices) {
  int decided = 0, scenes = 0;
  for (const View& view : views())
    for (const bool column : {true, false}) {
      SCOPED_TRACE("scene " + std::to_string(scenes++));
      const SightPlane plane(view, column, (column ? view.size.width : view.size.height) / 2);
      const double distance = 3 * view.per_tangent / (0.5 * view.size.height);
      const glm::dvec3 corner =
          view.camera.position + plane.into * distance - plane.along * 0.9 - plane.across * (3 * 0.41);
      decided +=
          expect_the_limit(box({5, 4, 6}, corner, plane.along * 0.37, plane.into * 0.29, plane.across * 0.41), view);
    }
  EXPECT_GT(decided, 100);
}

TEST(PerspectiveTies, LatticesInRaysAreTheLimitOfShiftedLattices) {
  // All vertical and horizontal faces are in planes through the eye and pixel centres, and all edges along the view are
  // on rays through pixel centres.
  int decided = 0, scenes = 0;
  for (const View& view : views()) {
    SCOPED_TRACE("scene " + std::to_string(scenes++));
    TetMesh mesh = box({4, 5, 3}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    for (glm::dvec3& p : mesh.positions) {
      const double x = std::array{1.5, 4.5, 5.5, 12.5, 18.5}[static_cast<std::size_t>(p.x)];
      const double y = std::array{0.5, 2.5, 6.5, 9.5, 10.5, 15.5}[static_cast<std::size_t>(p.y)];
      p = view.camera.position + view.towards(x, y) * (1.3 + 0.7 * p.z);
    }
    decided += expect_the_limit(mesh, view);
  }
  EXPECT_GT(decided, 1000);
}

TEST(PerspectiveTies, MeshesAroundTheEyeAreTheLimitOfShiftedMeshes) {
  // The eye is in the mesh (in a plane of faces, on an edge or on a vertex), at its surface, or next to it. Vertices
  // are in the eye's plane and behind the eye.
  int decided = 0, scenes = 0;
  bool column = true;  // alternating
  test::SomeCases some(5);
  for (const glm::dvec3& eye :
       {glm::dvec3(1.3, 1.6, 2), {2.2, 0, 2}, {1.4, 2.3, 0}, {2, 1.5, 2}, {2, 2, 2}, {1.5, -0.5, 1}})
    for (const View& view : views()) {
      if (!some.next()) continue;
      SCOPED_TRACE("scene " + std::to_string(scenes++));
      column = !column;
      const SightPlane plane(view, column, (column ? view.size.width : view.size.height) / 2 - 1);
      const glm::dvec3 u = plane.along * 0.37, v = plane.into * 0.29, w = plane.across * 0.41;
      const glm::dvec3 position = view.camera.position;
      TetMesh mesh = box({4, 4, 4}, position - eye.x * u - eye.y * v - eye.z * w, u, v, w);
      for (glm::dvec3& p : mesh.positions)
        if (glm::length(p - position) < 1e-9) p = position;  // rounding must not move this vertex away from the eye
      decided += expect_the_limit(mesh, view);
    }
  EXPECT_GT(decided, 100);
}

}  // namespace
}  // namespace tessera::frame::perspective_ties_test
