// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tessera/field_info.hpp"
#include "tessera/read_progress.hpp"
#include "tessera/selection.hpp"
#include "tessera/warp.hpp"

namespace tessera::cells {

/// What the user may say about a mesh file; the defaults read any file that can be read.
struct MeshOptions {
  /// Scalar to render: "" (the reader's choice, said in the notes), "NAME", "NAME:mag", "NAME:x", "NAME:0", each with
  /// an optional "point:" or "cell:" before it. A vector with no component named gives its magnitude.
  std::string field;
  bool smooth = false;                     ///< average cell data to the points, weighted by tet volume
  std::filesystem::path plot3d_q;          ///< PLOT3D solution file; empty: found next to the grid file by name
  std::optional<double> max_volume;        ///< surfaces only: largest tet TetGen makes, world units cubed
  std::optional<std::size_t> time_step{};  ///< files of several: counted from 0; default the last
  int threads = 1;                         ///< that make tets of cells; 0: all cores
  /// Of files in blocks: names of those to read (cells/block_choice.hpp); none: all.
  std::vector<std::string> blocks{};
  /// Cells of second and higher order become tets that are this near to them: in position of the mesh's diagonal, in
  /// value of the field's range; and about so many tets at most, else the tolerance is larger. 0 tets: by their
  /// corners.
  double higher_order_tolerance = default_higher_order_tolerance;
  std::uint64_t higher_order_tets = default_higher_order_tets;
  ReadProgressFunction progress{};         ///< called with the progress; may be null
  bool shape = false;                      ///< ReadOptions::shape
  Selection selection{};                   ///< what of the mesh is kept
  bool surfaces = false;                   ///< blocks of faces, patches and side sets are read and named too
  std::optional<Warp> warp{};              ///< ReadOptions::warp
  bool drop_duplicates = false;            ///< ReadOptions::drop_duplicates
  std::optional<glm::dvec3> axis_scale{};  ///< ReadOptions::axis_scale
};

using tessera::HigherOrderCells;
using tessera::MeshCounts;

using FieldSummary = tessera::FieldInfo;

}  // namespace tessera::cells
