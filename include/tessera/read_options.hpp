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

/// How near tets come to cells of second and higher order where nothing else is said: in position of the mesh's
/// diagonal, in value of the field's range; and about how many there may be: not more than 2^18 and twice as many as
/// the mesh takes without the worst 48 of the tets that its cells' corners make, so that damage takes no memory out of
/// proportion. Any other number is taken as it is.
inline constexpr double default_higher_order_tolerance = 1e-4;
inline constexpr std::uint64_t default_higher_order_tets = std::uint64_t{1} << 21;

/// What may be said about a file; the defaults read any file that describes itself.
struct ReadOptions {
  /// Scalar to render: "" (the reader's choice, said in the notes), "NAME", "NAME:mag", "NAME:x", "NAME:0", each with
  /// an optional "point:" or "cell:" before it. A vector with no component named gives its magnitude.
  std::string field{};
  int threads = 0;                         ///< that make tets of cells, or scan samples; 0: all cores
  std::optional<std::size_t> time_step{};  ///< files of several: counted from 0; default the last

  // Meshes.
  /// What a mesh shows that has nothing to show, for who names neither field nor transfer function: where it has no
  /// field, or only constants and labels (ids, indices, ranks, materials), its shape, as point data named
  /// `shape_field_name`: how far each point lies towards the eye of the default view. false: the value 1 where there is
  /// no field, else the first of them, labels last.
  bool shape = false;
  bool smooth = false;  ///< average cell data to the points, weighted by tet volume
  /// How the points are moved. None: as the file means it, Exodus by its displacements, others not.
  std::optional<Warp> warp{};
  std::filesystem::path plot3d_q{};    ///< PLOT3D solution file; empty: found beside the grid file by its name
  std::optional<double> max_volume{};  ///< surfaces only: largest tet TetGen makes, world units cubed
  /// Files in blocks: names of those to read; none: all. Of a block that is in another ("fluid/internalMesh") the
  /// beginning or the end will do.
  std::vector<std::string> blocks{};
  /// Cells that have the corners of earlier ones, as where pieces, regions or blocks repeat each other, are left out.
  /// Otherwise all are drawn, and a warning says how many they are; of large meshes if a sample of their cells has
  /// some. On several ranks one reads the file whole, with it; without it the warning counts what each finds in its
  /// share.
  bool drop_duplicates = false;
  /// What of a mesh or grid is kept (tessera/selection.hpp). Bounds and default view are of that; range, transfer
  /// function and its unit distance are of the whole, so that a cut changes no colour.
  Selection selection{};
  /// What the axes of the world are multiplied by, each above 0, before anything else is done with places: clips, views
  /// and lengths are those of what is scaled. None: 1; but where x and y are degrees and z is a length, and the box is
  /// thinner than 1:20, z is scaled, which a note says (Dataset::axis_scale() has what was taken).
  std::optional<glm::dvec3> axis_scale{};

  /// Cells of second and higher order become tets that are this near to them: in value of the field's range, in
  /// position a quarter of it, of the mesh's diagonal. No more than about `higher_order_tets` are made of them, else
  /// the tolerance is larger; Dataset::higher_order_cells() says what was reached. 0 tets: they are drawn by their
  /// corners, without a bound.
  double higher_order_tolerance = default_higher_order_tolerance;
  std::uint64_t higher_order_tets = default_higher_order_tets;

  // A .raw file says nothing of itself, but perhaps by its name: NAME_WxHxD_TYPE.raw. These win over the name, and are
  // refused for other files.
  std::optional<GridIndex> dims{};
  std::optional<SampleType> type{};
  std::optional<glm::dvec3> spacing{}, origin{};
  bool big_endian = false;
  std::uint64_t skip = 0;  ///< bytes before the first sample
  /// Whether one of these is given.
  [[nodiscard]] bool describes_raw() const { return dims || type || spacing || origin || big_endian || skip > 0; }

  /// Grids: whether values are labels, which are not interpolated: each sample fills its voxel. None: as the header
  /// states, else by the values (whole numbers that neighbours share).
  std::optional<bool> labels{};

  /// Grids whose samples have to be unpacked (.vti, .vtr, .nii.gz, ...): where these take more than half of so many
  /// bytes, they go into a file without a name in the folder for temporary files, if there is room, and bricks are read
  /// from there. 0: they stay in memory. On several ranks of a machine they go there in any case.
  std::uint64_t memory_bytes = 0;

  /// Of a rectilinear grid, which is a mesh too: its voxels as hexahedra.
  bool grid_as_mesh = false;
  /// Meshes: tets keep their corners' order, for who writes them again. A session then keeps a copy, 16 bytes a tet.
  bool keep_corners = false;
  Trace* trace = nullptr;           ///< where the time of reading goes; null: nowhere
  ReadProgressFunction progress{};  ///< hears how far it is; null: nobody
};

}  // namespace v0_1
}  // namespace tessera
