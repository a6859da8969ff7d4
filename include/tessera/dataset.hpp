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
/// Cells   either `tets`, or `types`, `offsets` and `connectivity` as in VTK: cell c has type types[c] (CellType, or
///         VTK's number as an integer) and points connectivity[offsets[c]] up to connectivity[offsets[c + 1]]; there is
///         one offset more than there are cells.
/// Faces   of CellType::polyhedron, as in VTK up to 9.3: starting at face_locations[c], `faces` holds the number of the
///         cell's faces, then for each face the number of its points and the points, in either orientation. The
///         location of other cells is -1. Without polyhedra both may be empty. The points of a polyhedron in
///         `connectivity` are ignored. A polyhedron whose faces do not form a closed surface is left out
///         (MeshCounts::cells_open, Dataset::warnings()).
/// Copies  float64 points and scalars and uint32 tets are borrowed without a copy if point data are finite everywhere
///         and the corners of tets are in range; anything else is converted. One copy of the tets (16 bytes each) is
///         made unless each has its corners in the order of their positions (by x, then y, then z).
/// Blanks  cells with a scalar or corner that is NaN or infinite are left out, as in files.
struct MeshArrays {
  ArrayView points;  ///< three numbers per point
  ArrayView tets;    ///< four points per tet, either orientation
  ArrayView types, offsets, connectivity;
  ArrayView faces, face_locations;
  ArrayView scalars;  ///< one per point, or one per cell
  Association association = Association::point;
  std::string field_name = "scalar";
  /// As in ReadOptions, for cells of second and higher order. For a mesh in parts they apply to the whole mesh, and the
  /// smallest `higher_order_tets` of all ranks counts.
  double higher_order_tolerance = default_higher_order_tolerance;
  std::uint64_t higher_order_tets = default_higher_order_tets;
  /// With `tets`: uint64, one per tet: the cell of another mesh that it was made from; tets of one cell are contiguous.
  /// Empty: each tet is its own cell. Written by write_mesh; images do not depend on it.
  ArrayView original_cells{};
  /// Keeps the arrays alive for as long as the data set needs them; null: the caller does.
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

/// How the numbers of a preset or a file become extinction [1 / world unit] and linear colour.
struct TransferFunctionOptions {
  std::optional<double> unit_distance{};  ///< world units to which an opacity refers; overrides that of the file
  double opacity_scale = 1;               ///< multiplies extinction, >= 0
  bool display_colors = false;  ///< colours stay as in the file, not decoded from sRGB, as VTK composites them
  bool rescale = false;         ///< stretch a file's values over the field's range
  /// Presets, the default function and files are stretched over this range instead; low < high.
  std::optional<std::array<double, 2>> range{};
  /// Colours and opacities depend on the logarithm of the value. Values <= 0 count as the smallest positive one; a
  /// field without positive values is an error.
  bool logarithmic = false;
  /// Fractions of the range (0 to 1, ascending) and opacities per unit distance (0 to 1), linear between them. They
  /// replace the opacities of a preset or a colour map; not allowed for files that contain extinctions.
  std::vector<std::array<double, 2>> opacity_points{};
  /// Files over 0 to 1 or -1 to 1, like ParaView's presets, are stretched as by `rescale` if they would otherwise show
  /// almost nothing: if less than a hundredth of the field's range is within theirs, or the reverse.
  bool rescale_presets = false;
  /// Only for the warnings: how images are rendered. Independent emission shows light without extinction, and with
  /// surfaces a transparent function may be intended.
  Emission emission = Emission::absorption;
  bool with_surfaces = false;
};

/// A mesh or a grid with one scalar field, opened once. Immutable: copies share it, and so may threads and sessions.
///
/// On several ranks a data set is either whole on each of them, or opened by all together, with one part per rank.
class TESSERA_EXPORT Dataset {
 public:
  /// Opens a file; several files are the pieces of one mesh. The beginning of the file determines its format, otherwise
  /// its name (docs/FORMATS.md). Throws Error(bad_input) in one line for a missing, truncated, malformed or empty file
  /// or an unknown field, Error(system_failure) if memory runs out.
  static Dataset open(const std::filesystem::path& file, const ReadOptions& options = {});
  static Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& options = {});
  /// The same by all ranks of a communicator, which must also be that of the session. Where the format allows it, each
  /// projector reads its own part; otherwise one rank reads the file and distributes the parts. Grids are scanned by
  /// all ranks together and read brick by brick where they are needed. `ranks` as for the session. Collective.
  static Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& options,
                      const Communicator& communicator, const RankSettings& ranks = {});

  /// The same for a file that has already been identified.
  static Dataset open(const InputFile& file, const ReadOptions& options = {});
  static Dataset open(const InputFile& file, const ReadOptions& options, const Communicator& communicator,
                      const RankSettings& ranks = {});

  /// From the caller's arrays. Throws Error(bad_input) naming the wrong array and place, and if no cell or no finite
  /// sample remains.
  static Dataset of(const MeshArrays& arrays);
  static Dataset of(const GridArrays& arrays);
  /// From samples that are read where they are needed. All of them are read once at the beginning, for their range.
  static Dataset of(std::shared_ptr<const SampleSource> samples);
  /// From a mesh in parts, one per rank, as in a simulation: every cell is on one rank, without ghost cells; the part
  /// of a rank may be empty. Cells are numbered rank after rank. Collective; the communicator must also be that of the
  /// session, where every rank projects its own part.
  static Dataset of_parts(const MeshArrays& part, const Communicator& communicator);

  /// A part of a mesh that is whole on this rank (tessera/selection.hpp). It keeps this data set, which
  /// Session::verify() and Reference use to check clipped images. Throws Error(bad_input) for a grid or a part of a
  /// mesh, and if nothing remains.
  [[nodiscard]] Dataset selected(const Selection& selection) const;

  [[nodiscard]] bool is_mesh() const;
  [[nodiscard]] bool is_grid() const { return !is_mesh(); }

  /// Of the whole data set, on every rank.
  [[nodiscard]] const Box& bounds() const;
  /// Factors by which the file's axes were multiplied (ReadOptions::axis_scale).
  [[nodiscard]] const glm::dvec3& axis_scale() const;
  /// Smallest and largest value of the field, without blanks.
  [[nodiscard]] std::array<double, 2> range() const;
  [[nodiscard]] Association association() const;
  [[nodiscard]] const std::string& field_name() const;
  /// Whether the data set shows the shape of a mesh instead of a field (ReadOptions::shape).
  [[nodiscard]] bool shows_shape() const;
  /// The arrays of the file; for the caller's arrays, the one scalar array.
  [[nodiscard]] std::span<const FieldInfo> fields() const;
  /// One line each: what was chosen or applied, or is unusual about the file.
  [[nodiscard]] std::span<const std::string> notes() const;
  /// One line each: what is drawn differently from the file's contents, without a promise of accuracy; usually empty.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Number of time steps in its file, one of which was read; 1 if the data do not change with time.
  [[nodiscard]] std::size_t time_steps() const;
  /// The times of these steps, and of the step that was read, in the file's unit; empty if the file does not state
  /// them.
  [[nodiscard]] std::span<const double> times() const;
  [[nodiscard]] std::optional<double> time() const;
  /// Names of the file's blocks (ReadOptions::blocks), including those that were not read.
  [[nodiscard]] std::span<const std::string> blocks() const;
  /// Names of surfaces that accompany a mesh and were left out; read_block_surface() reads them: side sets, patches.
  [[nodiscard]] std::span<const std::string> surfaces() const;
  /// "VTK XML unstructured grid", "NRRD", ...; "arrays" for the caller's arrays.
  [[nodiscard]] const std::string& format() const;
  /// Its name in messages: the file, or "mesh" or "grid".
  [[nodiscard]] const std::string& source() const;

  /// For meshes; otherwise zero.
  [[nodiscard]] std::uint64_t tet_count() const;
  [[nodiscard]] const MeshCounts& mesh_counts() const;
  [[nodiscard]] const HigherOrderCells& higher_order_cells() const;
  /// The tets as they are rendered, on several ranks those of this rank: float64 points and scalars, uint32 tets. The
  /// arrays belong to this data set and keep it alive. Throws Error(bad_input) for a grid.
  [[nodiscard]] MeshArrays mesh_arrays() const;
  /// For grids. Throws Error(bad_input) for a mesh.
  [[nodiscard]] const GridGeometry& grid_geometry() const;
  [[nodiscard]] SampleType sample_type() const;
  /// value = scale * sample + shift; 1 and 0 for a mesh.
  [[nodiscard]] double scale() const;
  [[nodiscard]] double shift() const;
  [[nodiscard]] std::uint64_t blank_samples() const;

  /// The length to which an opacity refers if neither the file nor the caller states it, in world units: a tenth of the
  /// mean thickness, so that the presets' ramps make an average ray 0.26 to 0.89 opaque. For data without volume: a
  /// twentieth of the diagonal; without extent: 1.
  [[nodiscard]] double default_unit_distance() const;
  /// The view that frames all of the data: z up, flat data seen from above (tessera/default_view.hpp).
  [[nodiscard]] Camera default_camera(ImageSize size, ProjectionKind projection = ProjectionKind::orthographic) const;
  /// That camera with its size, as Session::render() takes it.
  [[nodiscard]] View default_view(ImageSize size, ProjectionKind projection = ProjectionKind::orthographic) const;
  /// Another view of all of the data. `turning`: wide enough for every turn of orbit(). Throws as view_of_box().
  [[nodiscard]] Camera view(const ViewRequest& request, ImageSize size,
                            ProjectionKind projection = ProjectionKind::orthographic, bool turning = false) const;
  /// The anatomical axes, if a medical file states them.
  [[nodiscard]] BodyAxes body_axes() const;
  /// A preset ("viridis", "cool-warm:rise", ...), a file, or the text of a JSON file (is_json_text(); messages call it
  /// `transfer_function`), over this field's range. "": the default, chosen by how the field's values are distributed
  /// over the volume (docs/REFERENCE.md, "The first picture"); it is the same for any number of ranks and threads. The
  /// first call samples the field at some ten thousand places. The result's `warnings` report what the function does
  /// not show. Throws Error(bad_input) naming file and line.
  [[nodiscard]] LoadedTransferFunction transfer_function(const std::string& file_or_preset = "",
                                                         const TransferFunctionOptions& options = {}) const;

  /// Overlapping cells, folds, unmatched faces, slivers and duplicates of a mesh that is whole on this rank. Throws
  /// Error(bad_input) for a grid or a part of a mesh. `progress` is called on the calling thread with the completed
  /// fraction, 0 to 1.
  [[nodiscard]] MeshCheck check(const CheckProgressFunction& progress = nullptr) const;

  /// Whether both are copies of one data set.
  [[nodiscard]] bool is_copy_of(const Dataset& other) const { return state_ == other.state_; }

  struct State;  ///< incomplete for callers

 private:
  friend struct StateAccess;
  explicit Dataset(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

/// Number of time steps in a mesh or grid file (ReadOptions::time_step); 1 if it does not change with time. Files whose
/// format may have several are opened with `options`; other files are not read. Throws as Dataset::open.
TESSERA_EXPORT std::size_t time_steps_of(const std::filesystem::path& file, const ReadOptions& options = {});

/// The times of these steps if the file states them; otherwise their numbers from 0.
TESSERA_EXPORT std::vector<double> times_of(const std::filesystem::path& file, const ReadOptions& options = {});
TESSERA_EXPORT std::vector<double> times_of(const InputFile& file, const ReadOptions& options = {});

/// The names of all presets' colours, the default first.
TESSERA_EXPORT std::vector<std::string> preset_names();

}  // namespace v0_1
}  // namespace tessera
