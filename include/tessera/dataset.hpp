// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/array.hpp"
#include "tessera/association.hpp"
#include "tessera/camera.hpp"
#include "tessera/communicator.hpp"
#include "tessera/default_view.hpp"
#include "tessera/export.hpp"
#include "tessera/field_info.hpp"
#include "tessera/grid.hpp"
#include "tessera/mesh_check.hpp"
#include "tessera/mesh_counts.hpp"
#include "tessera/read_options.hpp"
#include "tessera/sample_source.hpp"
#include "tessera/selection.hpp"
#include "tessera/settings.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/view.hpp"

namespace tessera {
inline namespace v0_1 {

class InputFile;  // tessera/input_file.hpp

/// A mesh in the caller's arrays.
///
/// Cells   either `tets`, or `types`, `offsets` and `connectivity` as VTK has them: cell c has type types[c]
///         (CellType, or VTK's number as an integer) and points connectivity[offsets[c]] up to
///         connectivity[offsets[c + 1]]; offsets are one more than cells.
/// Faces   of CellType::polyhedron, as VTK has them up to 9.3: at face_locations[c] `faces` has the number of the
///         cell's faces, then of each the number of its points and these, in either direction round. The location of
///         other cells is -1. Without polyhedra both may be empty. A polyhedron's points in `connectivity` are not
///         looked at.
///         One whose faces are no closed surface is left out (MeshCounts::cells_open, Dataset::warnings()).
/// Copies  float64 points and scalars and uint32 tets are borrowed as they stand, for point data that is finite
///         everywhere and tets whose corners are in range; anything else is converted. One copy of tets (16 bytes each)
///         is made unless each has its corners in the order of their positions (by x, then y, then z).
/// Blanks  cells with a scalar or corner that is NaN or infinite are left out, as from files.
struct MeshArrays {
  ArrayView points;  ///< three numbers a point
  ArrayView tets;    ///< four points a tet, either orientation
  ArrayView types, offsets, connectivity;
  ArrayView faces, face_locations;
  ArrayView scalars;  ///< one a point, or one a cell
  Association association = Association::point;
  std::string field_name = "scalar";
  /// As ReadOptions has them, of cells of second and higher order; in parts of the whole mesh, and the smallest of all
  /// ranks' count.
  double higher_order_tolerance = default_higher_order_tolerance;
  std::uint64_t higher_order_tets = default_higher_order_tets;
  /// Of `tets`: uint64, one each, the cell of another mesh that it was made of, tets of one cell next to each other.
  /// Empty: it is its own. Written by write_mesh; no picture depends on it.
  ArrayView original_cells{};
  /// Keeps the arrays alive for as long as the data set needs them; null: the caller sees to that.
  std::shared_ptr<const void> owner;
};

/// A regular or rectilinear grid in the caller's memory: samples with i fastest, never copied.
struct GridArrays {
  GridGeometry geometry;
  ArrayView samples;            ///< as many as geometry.samples(); no 64-bit integers
  double scale = 1, shift = 0;  ///< value = scale * sample + shift
  std::string field_name = "scalar";
  std::shared_ptr<const void> owner;  ///< as MeshArrays::owner
};

/// How a preset's or a file's numbers become extinction [1 / world unit] and linear colour.
struct TransferFunctionOptions {
  std::optional<double> unit_distance{};  ///< world units over which an opacity holds; wins over the file's own
  double opacity_scale = 1;               ///< multiplies extinction, >= 0
  bool display_colors = false;  ///< colours stay as the file shows them, undecoded from sRGB, as VTK composites them
  bool rescale = false;         ///< stretch a file's values over the field's range
  /// Presets, the default and files are stretched over this range instead; low < high.
  std::optional<std::array<double, 2>> range{};
  /// Colours and opacities go by the logarithm of the value. Values of 0 and below count as the smallest positive one;
  /// a field without positive values is an error.
  bool logarithmic = false;
  /// Fractions of the range (0 to 1, ascending) and opacities per unit distance (0 to 1), linear between them, instead
  /// of a preset's or a colour map's own. Files of extinctions have none to replace.
  std::vector<std::array<double, 2>> opacity_points{};
  /// Files over 0 to 1 or -1 to 1, as ParaView's presets are, are stretched as by `rescale` where they would show
  /// next to nothing: less than a hundredth of the field's range lies within theirs, or the reverse.
  bool rescale_presets = false;
  /// For the warnings: what pictures are made with. Light without extinction shows where emission is independent, and
  /// with surfaces a clear function may be meant.
  Emission emission = Emission::absorption;
  bool with_surfaces = false;
};

/// A mesh or a grid with one scalar field, opened once. Immutable: copies share it, and so may threads and sessions.
///
/// On several ranks a data set is whole on each of them, or opened by all together, each rank holding a part.
class TESSERA_EXPORT Dataset {
 public:
  /// Opens a file; several are the pieces of one mesh. What kind it is, is seen from what the file begins with, then
  /// from its name (docs/FORMATS.md). Throws Error(bad_input) in one line for a missing, truncated, malformed or empty
  /// file or an unknown field, Error(system_failure) if memory runs out.
  static Dataset open(const std::filesystem::path& file, const ReadOptions& options = {});
  static Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& options = {});
  /// The same by all ranks of a communicator, which must then be the session's: formats that can be read in parts are,
  /// each projector its share; others by one rank, which hands the parts on. Grids are scanned together and read brick
  /// by brick where they are needed. `ranks` as the session's. Collective.
  static Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& options,
                      const Communicator& communicator, const RankSettings& ranks = {});

  /// The same of a file that has been identified already.
  static Dataset open(const InputFile& file, const ReadOptions& options = {});
  static Dataset open(const InputFile& file, const ReadOptions& options, const Communicator& communicator,
                      const RankSettings& ranks = {});

  /// Of the caller's arrays. Throws Error(bad_input) naming the array and place at fault; no cell that is left, or no
  /// finite sample, is one too.
  static Dataset of(const MeshArrays& arrays);
  static Dataset of(const GridArrays& arrays);
  /// Of samples that are read where they are needed, all of them once at first for their range.
  static Dataset of(std::shared_ptr<const SampleSource> samples);
  /// Of a mesh in parts, one a rank, as a simulation has it: every cell on one rank, ghosts left out; a rank may have
  /// none. Cells are numbered rank after rank. Collective; the communicator must be the session's, where every rank
  /// projects what it has.
  static Dataset of_parts(const MeshArrays& part, const Communicator& communicator);

  /// A part of a mesh that is whole on this rank (tessera/selection.hpp). It keeps this data set, by which
  /// Session::verify() and Reference judge clipped pictures. Throws Error(bad_input) for a grid or a part, and if
  /// nothing is left.
  [[nodiscard]] Dataset selected(const Selection& selection) const;

  [[nodiscard]] bool is_mesh() const;
  [[nodiscard]] bool is_grid() const { return !is_mesh(); }

  /// Of the whole, on every rank.
  [[nodiscard]] const Box& bounds() const;
  /// What the file's axes were multiplied by (ReadOptions::axis_scale).
  [[nodiscard]] const glm::dvec3& axis_scale() const;
  /// Smallest and largest value of the field that is not blank.
  [[nodiscard]] std::array<double, 2> range() const;
  [[nodiscard]] Association association() const;
  [[nodiscard]] const std::string& field_name() const;
  /// Whether it is a mesh's shape instead of a field (ReadOptions::shape).
  [[nodiscard]] bool shows_shape() const;
  /// Arrays of the file; of the caller's, the one.
  [[nodiscard]] std::span<const FieldInfo> fields() const;
  /// One line each: what was chosen or applied, or odd about the file.
  [[nodiscard]] std::span<const std::string> notes() const;
  /// One line each: what is drawn otherwise than the file has it, so that no accuracy is promised for that; mostly
  /// none.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// How many time steps its file has, of which it is one; 1 of what does not change with time.
  [[nodiscard]] std::size_t time_steps() const;
  /// When these are, and when this one is, in the file's unit, where it says so; else none.
  [[nodiscard]] std::span<const double> times() const;
  [[nodiscard]] std::optional<double> time() const;
  /// Names of a file's blocks (ReadOptions::blocks), of those too that were not read.
  [[nodiscard]] std::span<const std::string> blocks() const;
  /// Names of the surfaces beside a mesh that were left out, which read_block_surface() reads: side sets, patches.
  [[nodiscard]] std::span<const std::string> surfaces() const;
  /// "VTK XML unstructured grid", "NRRD", ...; "arrays" of the caller's.
  [[nodiscard]] const std::string& format() const;
  /// What messages call it: the file, or "mesh" or "grid".
  [[nodiscard]] const std::string& source() const;

  /// Meshes, else zero.
  [[nodiscard]] std::uint64_t tet_count() const;
  [[nodiscard]] const MeshCounts& mesh_counts() const;
  [[nodiscard]] const HigherOrderCells& higher_order_cells() const;
  /// The tets as they are rendered, on several ranks this one's: float64 points and scalars, uint32 tets, borrowed from
  /// this data set and kept by it. Throws Error(bad_input) for a grid.
  [[nodiscard]] MeshArrays mesh_arrays() const;
  /// Grids. Throws Error(bad_input) for a mesh.
  [[nodiscard]] const GridGeometry& grid_geometry() const;
  [[nodiscard]] SampleType sample_type() const;
  /// value = scale * sample + shift; 1 and 0 of a mesh.
  [[nodiscard]] double scale() const;
  [[nodiscard]] double shift() const;
  [[nodiscard]] std::uint64_t blank_samples() const;

  /// The length over which an opacity holds where neither file nor caller says it, world units: a tenth of the mean
  /// thickness, so that the presets' ramps make an average ray 0.26 to 0.89 opaque. Of no volume: a twentieth of the
  /// diagonal; of no extent: 1.
  [[nodiscard]] double default_unit_distance() const;
  /// The view that frames all of it: heads up, what is flat from above (tessera/default_view.hpp).
  [[nodiscard]] Camera default_camera(ImageSize size, ProjectionKind projection = ProjectionKind::orthographic) const;
  /// That camera with its size, as Session::render() takes them.
  [[nodiscard]] View default_view(ImageSize size, ProjectionKind projection = ProjectionKind::orthographic) const;
  /// Another view of all of it. `turning`: wide enough for every turn of orbit(). Throws as view_of_box().
  [[nodiscard]] Camera view(const ViewRequest& request, ImageSize size,
                            ProjectionKind projection = ProjectionKind::orthographic, bool turning = false) const;
  /// Where a patient looks, of medical files that say so.
  [[nodiscard]] BodyAxes body_axes() const;
  /// A preset ("viridis", "cool-warm:rise", ...), a file, or the text of a JSON file (is_json_text()), which messages
  /// call `transfer_function`, over this field's range; "": the default, chosen by how the
  /// field's values share the volume (docs/REFERENCE.md, "The first picture"), the same for any number of ranks
  /// and threads. The first call looks at some ten thousand places of the field. What the function does not show is in
  /// its `warnings`. Throws Error(bad_input) naming file and line.
  [[nodiscard]] LoadedTransferFunction transfer_function(const std::string& file_or_preset = "",
                                                         const TransferFunctionOptions& options = {}) const;

  /// Overlapping cells, folds, unmatched faces, slivers, duplicates of a mesh that is whole on this rank. Throws
  /// Error(bad_input) for a grid or a part. `progress` hears how much is done, 0 to 1, on the calling thread.
  [[nodiscard]] MeshCheck check(const CheckProgressFunction& progress = nullptr) const;

  /// Whether both are copies of one data set that was opened once.
  [[nodiscard]] bool is_copy_of(const Dataset& other) const { return state_ == other.state_; }

  struct State;  ///< incomplete for callers

 private:
  friend struct StateAccess;
  explicit Dataset(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

/// How many time steps a mesh or grid file has (ReadOptions::time_step); 1 if it does not change with time. Formats
/// that may have several are looked into, as `options` say, others are not read. Throws as Dataset::open.
TESSERA_EXPORT std::size_t time_steps_of(const std::filesystem::path& file, const ReadOptions& options = {});

/// When they are, where the file says it; else their numbers from 0.
TESSERA_EXPORT std::vector<double> times_of(const std::filesystem::path& file, const ReadOptions& options = {});
TESSERA_EXPORT std::vector<double> times_of(const InputFile& file, const ReadOptions& options = {});

/// The names of all presets' colours, the default first.
TESSERA_EXPORT std::vector<std::string> preset_names();

}  // namespace v0_1
}  // namespace tessera
