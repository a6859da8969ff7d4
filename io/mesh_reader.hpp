#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::io {

/// What the user may say about a mesh file; the defaults read any file that can be read.
struct MeshOptions {
  /// Scalar to render: "" (the reader's choice, said in the notes), "NAME", "NAME:mag", "NAME:x", "NAME:0", each with
  /// an optional "point:" or "cell:" before it. A vector with no component named gives its magnitude.
  std::string field;
  bool smooth = false;                     ///< average cell data to the points, weighted by tet volume
  std::filesystem::path plot3d_q;          ///< PLOT3D solution file; empty: found beside the grid file by its name
  std::optional<double> max_volume;        ///< surfaces only: largest tet TetGen makes, world units cubed
  std::optional<std::size_t> time_step{};  ///< Exodus: step counted from 0; default the last one
  int threads = 1;                         ///< that make tets of cells; 0: all cores
};

/// What became of the file's cells and points. A cell is counted as read, then in at most one of ghost, hidden, nan,
/// not_volumetric; what remains is split into tets.
struct MeshCounts {
  std::uint64_t cells_read = 0;
  std::uint64_t cells_ghost = 0;           ///< dropped: another piece's (vtkGhostType bit 1, vtkGhostLevels > 0)
  std::uint64_t cells_hidden = 0;          ///< dropped: vtkGhostType bit 32, or a point of it hidden (2), IBLANK 0
  std::uint64_t cells_nan = 0;             ///< blanked: a coordinate or scalar of it is missing, NaN or infinite
  std::uint64_t cells_not_volumetric = 0;  ///< skipped: points, lines, faces
  std::uint64_t cells_zero_volume = 0;     ///< kept: all their tets have exactly no volume
  std::uint64_t cells_tangled = 0;         ///< kept: their tets differ in orientation, so they overlap
  std::uint64_t cells_quadratic = 0;       ///< kept: second or higher order, rendered by their corner nodes
  std::uint64_t points_read = 0;
  std::uint64_t points_unused = 0;   ///< of no tet; they stay in `positions`
  std::uint64_t tets_made = 0;       ///< in the mesh
  std::uint64_t tets_collapsed = 0;  ///< not made: two of their corners are one point in space

  MeshCounts& operator+=(const MeshCounts& other);  ///< of another part
  bool operator==(const MeshCounts&) const = default;
};

/// One array of the file as `info` lists it. Range and count are of all tuples, cells that were dropped included.
struct FieldSummary {
  std::string name;
  scene::Association association = scene::Association::point;
  int components = 1;
  std::string type;             ///< "float", "double", "int64", "uint8", ...
  double low = 0, high = 0;     ///< finite values, of the magnitude if there are several components; 0, 0 if none is
  std::uint64_t nan_count = 0;  ///< tuples that are NaN or infinite
  bool active = false;          ///< the file marks it as its scalars or vectors
};

struct MeshFile {
  scene::TetMesh mesh;
  MeshCounts counts;
  std::vector<FieldSummary> fields;
  std::vector<std::string> notes;  ///< one line each: what was chosen, or odd about the file
  std::string format;              ///< "VTK XML unstructured grid", "PLOT3D", "TetGen .node/.ele", ...
};

/// Reads a mesh by its name's extension: .vtu .pvtu .vts .pvts .vtr .pvtr .vtk, Exodus (.ex2 .e .exo .exii .g), PLOT3D
/// (.xyz .p3d .x .bin), TetGen (.node .ele), .tets, and surfaces filled by TetGen (.stl .ply .poly .smesh).
/// Cells other than tets are split so that neighbours agree on every shared face by position, whatever piece they come
/// from. Throws Error(bad_input) in one line for a missing, truncated, malformed or empty file, an unknown field, or if
/// no cell is left; Error(system_failure) if memory runs out. Never leaves VTK's own messages on stderr.
MeshFile read_mesh(const std::filesystem::path& file, const MeshOptions& options = {});

/// Reads several files as the pieces of one mesh, their points not merged. Each has to have the chosen field. Throws as
/// read_mesh.
MeshFile read_mesh(std::span<const std::filesystem::path> files, const MeshOptions& options = {});

/// Throws Error(bad_input) if the file is not there or has an extension that read_mesh does not know. Does not read it.
void require_mesh_file(const std::filesystem::path& file);

/// Whether read_mesh knows the extension (upper or lower case). Does not look at the file.
bool is_mesh_file(const std::filesystem::path& file);

/// Writes a .tets file: float32 coordinates and point scalars, so doubles are rounded. Appears by rename. Throws
/// Error(bad_input) for cell data, more than 2^31 - 1 points or values beyond float's range, Error(system_failure) if
/// it cannot be written.
void write_tets(const scene::TetMesh& mesh, const std::filesystem::path& file);

/// Writes a VTK XML unstructured grid, appended raw data with zlib, double coordinates and scalars; a cell array
/// "OriginalCellId" if tets were split from other cells. Appears by rename. Throws Error(system_failure).
void write_vtu(const scene::TetMesh& mesh, const std::filesystem::path& file);

}  // namespace tessera::io
