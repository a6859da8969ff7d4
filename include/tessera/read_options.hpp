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

/// Defaults for dividing cells of second and higher order into tets. The tolerance is relative: to the mesh's diagonal
/// for positions, to the field's range for values. Let n be the number of tets between the corners of these cells, and
/// m the number of tets that they need without the worst 48 of the n tets. With the default number of tets, the limit
/// is about 2^18 + 2 m, but at most 2^21 or 4 n, whichever is more, so that a damaged node does not require
/// disproportionate memory. Any other number is used unchanged as the limit.
inline constexpr double default_higher_order_tolerance = 1e-4;
inline constexpr std::uint64_t default_higher_order_tets = std::uint64_t{1} << 21;

/// Options for reading a file. The default values are suitable for any file that describes its own contents.
struct ReadOptions {
  /// Scalar to render: "" (the reader chooses and reports it in the notes), "NAME", "NAME:mag", "NAME:x" or "NAME:0",
  /// each with an optional prefix "point:" or "cell:". If no component of a vector is given, its magnitude is rendered.
  std::string field{};
  int threads = 0;                         ///< threads that split cells into tets or scan samples; 0: all cores
  std::optional<std::size_t> time_step{};  ///< for files with several steps, counted from 0; default: the last step

  // Meshes.
  /// What to show if a mesh has no meaningful field and the caller specifies neither a field nor a transfer function.
  /// Constants and labels (ids, indices, ranks, materials) are not meaningful. true: the mesh's shape, as point data
  /// named `shape_field_name`, whose values increase towards the eye of the default view. false:
  /// the first field, labels last, or the value 1 if there is no field.
  bool shape = false;
  bool smooth = false;  ///< convert cell data to point data: averages weighted by the volumes of the tets
  /// How the points are moved. None: the points of Exodus files are moved by the displacements in the file, other
  /// points are not moved.
  std::optional<Warp> warp{};
  std::filesystem::path plot3d_q{};    ///< PLOT3D solution file; empty: a file next to the grid file with a matching
                                       ///< name
  std::optional<double> max_volume{};  ///< surfaces only: volume of the largest tet that TetGen makes, world units
                                       ///< cubed
  /// For files with blocks: names of the blocks to read. Empty: all blocks. The beginning or the end of the name of a
  /// nested block ("fluid/internalMesh") is sufficient.
  std::vector<std::string> blocks{};
  /// If true, cells that have the corners of earlier cells are left out. Such duplicates occur where pieces, regions or
  /// blocks repeat each other. Otherwise all cells are drawn, and a warning reports the number of duplicates (in large
  /// meshes only if a sample of the cells contains any). On several ranks, this option makes one rank read the whole
  /// file; without it, the warning counts the duplicates that each rank finds in its own part.
  bool drop_duplicates = false;
  /// The part of a mesh or grid to keep (tessera/selection.hpp). Bounds and default view are those of this part. The
  /// range, the transfer function and its unit distance are those of the whole data, so that a cut does not change
  /// colours.
  Selection selection{};
  /// Factors by which the world's axes are multiplied, each > 0. They are applied first: clips, views and lengths refer
  /// to the scaled data. None: the factors are 1, but z is scaled if x and y are degrees, z is a length, and the box is
  /// thinner than 1:20; a note then reports the factor. Dataset::axis_scale() returns the factors used.
  std::optional<glm::dvec3> axis_scale{};

  /// Tolerance for dividing cells of second and higher order into tets. Values differ by at most this fraction of the
  /// field's range; positions differ by at most a quarter of this fraction times the mesh's diagonal. If this required
  /// more than about `higher_order_tets` tets, the tolerance is raised, and Dataset::higher_order_cells() returns the
  /// tolerance that was reached. If `higher_order_tets` is 0, these cells are drawn as linear cells between their
  /// corners, without an error bound.
  double higher_order_tolerance = default_higher_order_tolerance;
  std::uint64_t higher_order_tets = default_higher_order_tets;

  // A .raw file contains no description of its samples; only its name may describe them: NAME_WxHxD_TYPE.raw. These
  // options override the name. For other files they cause an error.
  std::optional<GridIndex> dims{};
  std::optional<SampleType> type{};
  std::optional<glm::dvec3> spacing{}, origin{};
  bool big_endian = false;
  std::uint64_t skip = 0;  ///< number of bytes before the first sample
  /// Whether any option for .raw files is set.
  [[nodiscard]] bool describes_raw() const { return dims || type || spacing || origin || big_endian || skip > 0; }

  /// Grids: whether values are labels. Labels are not interpolated: each sample fills its voxel. None: the header of
  /// the file decides. If the header does not state this, the values decide: whole numbers that neighbouring samples
  /// share are labels.
  std::optional<bool> labels{};

  /// For grids whose samples must be unpacked (.vti, .vtr, .nii.gz, ...): if the samples take more than half of this
  /// number of bytes, they are written to a nameless file in the directory for temporary files, if there is room, and
  /// bricks are read from that file. 0: the samples stay in memory. Several ranks of a machine always share such a
  /// file.
  std::uint64_t memory_bytes = 0;

  /// Opens a rectilinear grid as a mesh whose cells are the voxels, as hexahedra.
  bool grid_as_mesh = false;
  /// Meshes: the corners of tets keep their order, for callers that write the mesh to a file. A session then needs a
  /// copy of the tets, 16 bytes per tet.
  bool keep_corners = false;
  Trace* trace = nullptr;           ///< records the time spent reading; may be null
  ReadProgressFunction progress{};  ///< called with the progress; may be null
};

}  // namespace v0_1
}  // namespace tessera
