// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tessera/grid.hpp"
#include "tessera/read_progress.hpp"
#include "tessera/selection.hpp"
#include "tessera/warp.hpp"

namespace tessera {
inline namespace v0_1 {

class Trace;

/// Default tolerance of the tets of cells of second and higher order: position relative to the mesh's diagonal, value
/// relative to the field's range. Default number of tets: about 2^18 plus twice as many as the mesh needs without the
/// 48 worst of the tets between its cells' corners; at most 2^21, or four per tet between corners if that is more. So a
/// damaged node does not take disproportionate memory. Any other number is used as it is.
inline constexpr double default_higher_order_tolerance = 1e-4;
inline constexpr std::uint64_t default_higher_order_tets = std::uint64_t{1} << 21;

/// Options for reading a file; the defaults read any file that describes itself.
struct ReadOptions {
  /// Scalar to render: "" (chosen by the reader, stated in the notes), "NAME", "NAME:mag", "NAME:x", "NAME:0", each
  /// with an optional prefix "point:" or "cell:". A vector without a component gives its magnitude.
  std::string field{};
  int threads = 0;                         ///< that make tets from cells, or scan samples; 0: all cores
  std::optional<std::size_t> time_step{};  ///< files with several: counted from 0; default: the last

  // Meshes.
  /// What to show if a mesh has no meaningful field (none at all, or only constants and labels: ids, indices, ranks,
  /// materials) and the caller names neither a field nor a transfer function. true: its shape, as point data named
  /// `shape_field_name`: the distance of each point towards the eye of the default view. false: the value 1 if there is
  /// no field, otherwise the first field, labels last.
  bool shape = false;
  bool smooth = false;  ///< average cell data to the points, weighted by tet volume
  /// How the points are moved. None: as the file specifies: by the displacements in Exodus files, not at all in others.
  std::optional<Warp> warp{};
  std::filesystem::path plot3d_q{};    ///< PLOT3D solution file; empty: found next to the grid file by its name
  std::optional<double> max_volume{};  ///< surfaces only: largest tet that TetGen makes, world units cubed
  /// Files with blocks: names of the blocks to read; none: all. A nested block ("fluid/internalMesh") may be named by
  /// the beginning or the end of its name.
  std::vector<std::string> blocks{};
  /// Leaves out cells that have the corners of earlier ones, which occur where pieces, regions or blocks repeat each
  /// other. Otherwise all are drawn, and a warning reports their number (in large meshes, if a sample of the cells
  /// contains any). On several ranks one rank then reads the whole file; without this option the warning counts the
  /// duplicates that each rank finds in its own part.
  bool drop_duplicates = false;
  /// The part of a mesh or grid to keep (tessera/selection.hpp). Bounds and default view are those of the part; range,
  /// transfer function and its unit distance are those of the whole, so that a cut changes no colour.
  Selection selection{};
  /// Factors of the world's axes, each > 0, applied before anything else: clips, views and lengths refer to the scaled
  /// data. None: 1, except that z is scaled if x and y are degrees, z is a length, and the box is thinner than 1:20. A
  /// note then reports it (Dataset::axis_scale() returns the factors used).
  std::optional<glm::dvec3> axis_scale{};

  /// Tolerance of the tets made from cells of second and higher order: the value differs by at most this fraction of
  /// the field's range, the position by at most a quarter of it times the mesh's diagonal. At most about
  /// `higher_order_tets` are made; otherwise the tolerance is raised, and Dataset::higher_order_cells() returns the one
  /// that was reached. 0 tets: these cells are drawn by their corners, without a bound.
  double higher_order_tolerance = default_higher_order_tolerance;
  std::uint64_t higher_order_tets = default_higher_order_tets;

  // A .raw file does not describe itself, except perhaps by its name: NAME_WxHxD_TYPE.raw. These options override the
  // name and are refused for other files.
  std::optional<GridIndex> dims{};
  std::optional<SampleType> type{};
  std::optional<glm::dvec3> spacing{}, origin{};
  bool big_endian = false;
  std::uint64_t skip = 0;  ///< bytes before the first sample
  /// Whether any of these is set.
  [[nodiscard]] bool describes_raw() const { return dims || type || spacing || origin || big_endian || skip > 0; }

  /// Grids: whether values are labels, which are not interpolated: each sample fills its voxel. None: as the header
  /// states, otherwise decided by the values (whole numbers that neighbours share).
  std::optional<bool> labels{};

  /// Grids whose samples must be unpacked (.vti, .vtr, .nii.gz, ...): if these take more than half of this number of
  /// bytes, they are written to a nameless file in the directory for temporary files, if there is room, and bricks are
  /// read from there. 0: they stay in memory. Several ranks of a machine always share such a file.
  std::uint64_t memory_bytes = 0;

  /// For a rectilinear grid, which can also be opened as a mesh: its voxels as hexahedra.
  bool grid_as_mesh = false;
  /// Meshes: tets keep the order of their corners, for callers that write the mesh out. A session then keeps a copy, 16
  /// bytes per tet.
  bool keep_corners = false;
  Trace* trace = nullptr;           ///< records the time spent reading; may be null
  ReadProgressFunction progress{};  ///< called with the progress; may be null
};

}  // namespace v0_1
}  // namespace tessera
