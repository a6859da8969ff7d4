#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/time_step_read.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/field_info.hpp"
#include "tessera/read_progress.hpp"
#include "tessera/selection.hpp"
#include "tessera/warp.hpp"

namespace tessera::io {

/// What the user may say about a mesh file; the defaults read any file that can be read.
struct MeshOptions {
  /// Scalar to render: "" (the reader's choice, said in the notes), "NAME", "NAME:mag", "NAME:x", "NAME:0", each with
  /// an optional "point:" or "cell:" before it. A vector with no component named gives its magnitude.
  std::string field;
  bool smooth = false;                     ///< average cell data to the points, weighted by tet volume
  std::filesystem::path plot3d_q;          ///< PLOT3D solution file; empty: found beside the grid file by its name
  std::optional<double> max_volume;        ///< surfaces only: largest tet TetGen makes, world units cubed
  std::optional<std::size_t> time_step{};  ///< files of several: counted from 0; default the last
  int threads = 1;                         ///< that make tets of cells; 0: all cores
  /// Of files in blocks: names of those to read (io/block_choice.hpp); none: all.
  std::vector<std::string> blocks{};
  /// Cells of second and higher order become tets that are this near to them: in position of the mesh's diagonal, in
  /// value of the field's range; and about so many tets at most, else the tolerance is larger. 0 tets: by their
  /// corners.
  double higher_order_tolerance = default_higher_order_tolerance;
  std::uint64_t higher_order_tets = default_higher_order_tets;
  ReadProgressFunction progress{};         ///< null: nobody hears
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

struct MeshFile {
  scene::TetMesh mesh;
  MeshCounts counts;
  HigherOrderCells higher_order;
  std::vector<FieldSummary> fields;
  std::vector<std::string> notes;     ///< one line each: what was chosen, or odd about the file
  std::vector<std::string> blocks;    ///< names of all that the file has, read or not
  std::vector<std::string> surfaces;  ///< names of those beside the volume, which block_surface.hpp reads
  TimeStepRead time_step{};
  glm::dvec3 axis_scale{1};  ///< that the points are multiplied by
  std::string format;        ///< "VTK XML unstructured grid", "PLOT3D", "TetGen .node/.ele", ...
};

/// Reads a mesh of any format of io/file_kinds.cpp, told by what it begins with, then by its name; or a gzip file of
/// one, inflated into memory. Surfaces are filled by TetGen. Cells other than tets are split so that neighbours agree
/// on every shared face by position, whatever piece they come from. Throws Error(bad_input) in one line for a missing,
/// truncated, malformed or empty file, an unknown format or field, or if no cell is left; Error(system_failure) if
/// memory runs out. Never leaves VTK's own messages on stderr.
MeshFile read_mesh(const std::filesystem::path& file, const MeshOptions& options = {});

/// Reads several files as the pieces of one mesh, their points not merged. Each has to have the chosen field. Throws as
/// read_mesh.
MeshFile read_mesh(std::span<const std::filesystem::path> files, const MeshOptions& options = {});

/// The cells of a file's chosen blocks as they are before they are split, and the names of all its blocks. Throws as
/// read_mesh, but not if there are none.
struct MeshBlocks;
MeshBlocks read_mesh_blocks(const std::filesystem::path& file, const MeshOptions& options);

/// The time steps that a mesh file has, and when they are. Of formats that may have several the helper opens it. Throws
/// as read_mesh.
TimeStepRead time_steps_of_mesh(const std::filesystem::path& file, const MeshOptions& options = {});

/// Throws Error(bad_input) if the file is not there or read_mesh does not know its format. Does not read it.
void require_mesh_file(const std::filesystem::path& file);

/// Whether read_mesh knows the format: by what the file begins with, or by its name where that says nothing or it is
/// not there. Rectilinear grids are volumes too.
bool is_mesh_file(const std::filesystem::path& file);

/// Writes a .tets file: float32 coordinates and point scalars, so doubles are rounded. Appears by rename. Throws
/// Error(bad_input) for cell data, more than 2^31 - 1 points or values beyond float's range, Error(system_failure) if
/// it cannot be written.
void write_tets(const scene::TetMeshView& mesh, const std::filesystem::path& file);

/// Writes a VTK XML unstructured grid, appended raw data with zlib, double coordinates and scalars; a cell array
/// "OriginalCellId" if tets were split from other cells. Appears by rename. Throws Error(system_failure).
void write_vtu(const scene::TetMeshView& mesh, const std::filesystem::path& file);

}  // namespace tessera::io
