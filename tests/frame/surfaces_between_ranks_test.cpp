// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "exchange/loopback_transport.hpp"
#include "frame/image_difference.hpp"
#include "frame/mesh/boundary_faces.hpp"
#include "frame/render_parts.hpp"
#include "scene/mesh_facts.hpp"

/// Surfaces rendered by several ranks have the same position and light as with one rank.
namespace tessera::frame::surfaces_between_ranks_test {
namespace {

/// Compares the images of three ranks, exchanged as segments and as runs, with those of one process, with and without
/// sharing of parts.
void expect_those_of_one_process(const scene::TetMesh& mesh, DistributedSettings settings, const FrameJob& job,
                                 const scene::TransferFunction& function) {
  const auto expected = Renderer(mesh, settings.render).render(job.camera, job.size, function);
  Settings in_double = settings.render;
  in_double.use.lattice = false;
  const auto expected_in_double = Renderer(mesh, in_double).render(job.camera, job.size, function);
  for (const auto& [how, sharing] : {std::pair{datasets::Partition::random_blobs, true},
                                     {datasets::Partition::interleaved, true},
                                     {datasets::Partition::random_blobs, false},
                                     {datasets::Partition::interleaved, false}}) {
    const auto parts = datasets::parts(mesh, 3, how, 5);
    settings.render.use.sharing = sharing;
    settings.exchange = Exchange::segments;
    const auto segments = render_parts(parts, settings, job, function);
    ASSERT_EQ(segments.size(), 1u);
    EXPECT_EQ(segments[0].image.rgba, expected.rgba) << "segments";
    EXPECT_EQ(segments[0].image.depth, expected.depth);
    settings.exchange = Exchange::runs;
    const auto runs = render_parts(parts, settings, job, function);
    // Runs are rounded to float, with an error of 6e-8 of their light. Ranks that share no memory cut runs at triangles
    // in double precision.
    const bool cut = settings.render.surfaces.has_faces() && !sharing;
    EXPECT_LT(difference(runs.at(0).image, cut ? expected_in_double : expected), 2e-6);
    EXPECT_FALSE(runs.at(0).overlapping);
  }
}

TEST(SurfacesBetweenRanks, MatchThoseOfOneProcess) {
  scene::TetMesh mesh = datasets::cube(8, 0.2);
  // Some vertices have the values of surfaces, so these surfaces coincide with faces shared by ranks.
  for (std::size_t i = 0; i < mesh.scalars.size(); i += 3) mesh.scalars[i] = std::round(mesh.scalars[i] * 8) / 8;
  const scene::TransferFunction function({{0, {0, 0, 0.3}, 0}, {0.5, {0.2, 0.9, 0.3}, 0}, {1, {1, 0.4, 0.2}, 2}});
  DistributedSettings settings;
  settings.render.integrator.kind = scene::IntegratorKind::exact;
  settings.render.threads = 1;
  settings.render.memory_bytes = 256ull << 20;
  for (int i = 1; i < 8; ++i) settings.render.surfaces.iso.push_back({i / 8., {}, i == 7 ? 1 : 0.1 * i});
  FrameJob job{{}, {61, 47}, 0};
  job.camera.position = {3.1, 2.3, 4.2};
  for (const bool perspective : {false, true})
    for (const bool lattice : {true, false}) {
      job.camera.projection = perspective ? scene::ProjectionKind::perspective : scene::ProjectionKind::orthographic;
      job.camera.view_angle = 30;
      settings.render.use.lattice = lattice;
      SCOPED_TRACE(::testing::Message() << "lattice " << lattice << ", perspective " << perspective);
      expect_those_of_one_process(mesh, settings, job, function);
    }
}

/// The mesh's boundary, and triangles through it and beyond.
scene::Surfaces faces() {
  auto triangles = std::make_shared<TriangleMesh>();
  triangles->points = {{-1.5, -1.2, 0.1}, {1.6, -1.1, -0.3}, {0.2, 1.7, 0.4}, {-1, 0.3, -1.4}, {0.9, 0.2, 1.5}};
  triangles->triangles = {{0, 1, 2}, {2, 3, 4}, {0, 3, 4}};
  scene::Surfaces surfaces;
  surfaces.boundary = {{{}, 0.3}};
  surfaces.triangles = {{triangles, glm::dvec3(1, 0.5, 0), 0.4}};
  return surfaces;
}

TEST(SurfacesBetweenRanks, OfFacesMatchThoseOfOneProcess) {
  const scene::TransferFunction function({{0, {0, 0, 0.3}, 0}, {0.5, {0.2, 0.9, 0.3}, 0}, {1, {1, 0.4, 0.2}, 2}});
  DistributedSettings settings;
  settings.render.integrator.kind = scene::IntegratorKind::exact;
  settings.render.threads = 1;
  settings.render.memory_bytes = 256ull << 20;
  settings.render.surfaces = faces();
  FrameJob job{{}, {61, 47}, 0};
  for (const bool cells : {false, true}) {
    scene::TetMesh mesh = datasets::cube(6, cells ? 0.2 : 0.0);
    if (cells) {
      mesh.association = scene::Association::cell;
      mesh.scalars.resize(mesh.tets.size());
      for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.scalars[t] = static_cast<double>(t % 11) / 10;
    }
    for (const glm::dvec3 eye : {glm::dvec3(3.1, 2.3, 4.2), glm::dvec3(0.1, 0.2, 0.15), glm::dvec3(0, 0, 5)})
      for (const bool perspective : {false, true}) {
        job.camera.position = eye;
        job.camera.projection = perspective ? scene::ProjectionKind::perspective : scene::ProjectionKind::orthographic;
        job.camera.view_angle = 40;
        SCOPED_TRACE(::testing::Message() << "cells " << cells << ", perspective " << perspective);
        expect_those_of_one_process(mesh, settings, job, function);
      }
  }
}

TEST(SurfacesBetweenRanks, OfMoreTrianglesThanAWindowHoldsMatchThoseOfOneProcess) {
  // Rays meet 100 sheets in front of, in and behind the cells. Each rank has a share of the sheets.
  auto sheets = std::make_shared<TriangleMesh>();
  for (std::uint32_t i = 0; i < 100; ++i) {
    const double z = 2 - 0.04 * i;
    for (const glm::dvec3& p : {glm::dvec3(-3, -3, z), glm::dvec3(3, -3, z + 0.01), glm::dvec3(0, 3, z - 0.01)})
      sheets->points.push_back(p);
    sheets->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  DistributedSettings settings;
  settings.render.integrator.kind = scene::IntegratorKind::exact;
  settings.render.threads = 1;
  settings.render.memory_bytes = 256ull << 20;
  settings.render.surfaces.triangles = {{sheets, glm::dvec3(1, 0.5, 0), 0.02}};
  FrameJob job{{}, {31, 31}, 0};
  job.camera.position = {0.3, 0.2, 5};
  job.camera.parallel_scale = 1.6;
  const scene::TransferFunction function({{0, {0.2, 0.4, 0.9}, 0.2}, {1, {1, 0.4, 0.2}, 0.4}});
  expect_those_of_one_process(datasets::cube(3, 0.2), settings, job, function);
}

/// The boundary again as triangles of a surface, every second one reversed.
std::shared_ptr<TriangleMesh> skin_of(const scene::TetMesh& mesh) {
  auto skin = std::make_shared<TriangleMesh>(boundary_faces(mesh).mesh);
  for (std::size_t t = 0; t < skin->triangles.size(); t += 2) std::swap(skin->triangles[t][0], skin->triangles[t][1]);
  return skin;
}

TEST(SurfacesBetweenRanks, ThatCoincideHaveTheOrderOfOneProcess) {
  const scene::TransferFunction function({{0, {0.2, 0.4, 0.9}, 0.5}, {1, {1, 0.4, 0.2}, 0.5}});
  FrameJob job{{}, {31, 31}, 0};
  for (const bool regular : {true, false}) {
    const scene::TetMesh mesh = datasets::cube(3, regular ? 0.0 : 0.2);
    DistributedSettings settings;
    settings.render.integrator.kind = scene::IntegratorKind::exact;
    settings.render.threads = 1;
    settings.render.memory_bytes = 256ull << 20;
    settings.render.surfaces.boundary = {{glm::dvec3(1, 0, 0), 0.5}};
    settings.render.surfaces.triangles = {{skin_of(mesh), glm::dvec3(0, 0, 1), 0.5}, {skin_of(mesh), {}, 0.3}};
    settings.render.surfaces.iso = {{0.5, {}, 0.4}};
    for (const glm::dvec3 eye : {glm::dvec3(3.1, 2.3, 4.2), glm::dvec3(0, 0, 5)}) {
      job.camera.position = eye;
      job.camera.projection = scene::ProjectionKind::orthographic;
      job.camera.parallel_scale = 1.6;
      SCOPED_TRACE(::testing::Message() << "regular " << regular << ", eye at z " << eye.z);
      expect_those_of_one_process(mesh, settings, job, function);
    }
  }
}

TEST(RunsBetweenRanks, ReportWhereCellsOverlap) {
  const scene::TransferFunction function({{0, {0.2, 0.4, 0.9}, 0.5}, {1, {1, 0.4, 0.2}, 0.5}});
  const auto cube_at = [](double x) {
    scene::TetMesh mesh = datasets::cube(3, 0.2);
    for (glm::dvec3& p : mesh.positions) p.x += x;
    return mesh;
  };
  FrameJob job{{}, {31, 31}, 0};
  job.camera.position = {3.1, 2.3, 4.2};
  for (const double apart : {0.0, 0.5, 1.9, 2.5}) {
    for (const bool lattice : {true, false}) {
      DistributedSettings settings;
      settings.exchange = Exchange::runs;
      settings.render.use.sharing = false;  // otherwise ranks of one machine have all cells of a tile
      settings.render.use.lattice = lattice;
      std::vector<scene::TetMesh> parts{cube_at(0), cube_at(apart)};
      std::uint32_t number = 0;
      for (scene::TetMesh& part : parts) {
        part.original_cell.resize(part.tets.size());
        for (auto& cell : part.original_cell) cell = number++;
      }
      EXPECT_EQ(render_parts(parts, settings, job, function).at(0).overlapping, apart < 2)
          << apart << ", lattice " << lattice;
    }
  }
}

TEST(SurfacesBetweenRanks, AreInDeepPicturesToo) {
  const scene::TetMesh mesh = datasets::cube(5, 0.2);
  const scene::TransferFunction function({{0, {0, 0, 0.3}, 0.1}, {1, {1, 0.4, 0.2}, 2}});
  DistributedSettings settings;
  settings.render.integrator.kind = scene::IntegratorKind::exact;
  settings.render.threads = 1;
  settings.render.memory_bytes = 256ull << 20;
  settings.render.surfaces = faces();
  settings.render.surfaces.iso = {{0.4, {}, 0.3}, {0.6, {}, 1}};
  settings.exchange = Exchange::segments;
  settings.frame.deep = true;
  FrameJob job{{}, {31, 23}, 0};
  job.camera.position = {3.1, 2.3, 4.2};
  scene::DeepImage expected;
  Renderer(mesh, settings.render).render(job.camera, job.size, function, nullptr, &expected);
  const auto frames =
      render_parts(datasets::parts(mesh, 3, datasets::Partition::interleaved, 5), settings, job, function);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].deep.begin, expected.begin);
  ASSERT_EQ(frames[0].deep.samples.size(), expected.samples.size());
  for (std::size_t i = 0; i < expected.samples.size(); ++i) {
    EXPECT_EQ(frames[0].deep.samples[i].z, expected.samples[i].z);
    EXPECT_EQ(frames[0].deep.samples[i].red, expected.samples[i].red);
    EXPECT_EQ(frames[0].deep.samples[i].alpha, expected.samples[i].alpha);
  }
}

}  // namespace
}  // namespace tessera::frame::surfaces_between_ranks_test
