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
/// Cells   either `tets`, or `types`, `offsets` and `connectivity` as in VTK: cell c has the type types[c] (CellType,
///         or VTK's number as an integer) and the points from connectivity[offsets[c]] to connectivity[offsets[c + 1] -
///         1]. There is one more offset than there are cells.
/// Faces   the faces of cells of CellType::polyhedron, as in VTK up to 9.3. Starting at face_locations[c], `faces`
///         contains the number of the cell's faces, then for each face the number of its points and the points, in
///         either orientation. face_locations[c] is -1 for other cells. In a mesh without polyhedra both arrays may be
///         empty. The points of a polyhedron in `connectivity` are ignored. A polyhedron whose faces do not form a
///         closed surface is left out (MeshCounts::cells_open, Dataset::warnings()).
/// Copies  Points and scalars of float64 and tets of uint32 are not copied if point data are finite everywhere and the
///         corners of tets are in range; all other arrays are converted. One copy of the tets (16 bytes each) is made
///         unless the corners of each tet are in the order of their positions (by x, then y, then z).
/// Blanks  Cells with a scalar or corner that is NaN or infinite are left out, as they are for files.
struct MeshArrays {
  ArrayView points;  ///< three numbers per point
  ArrayView tets;    ///< four points per tet, either orientation
  ArrayView types, offsets, connectivity;
  ArrayView faces, face_locations;
  ArrayView scalars;  ///< one per point, or one per cell
  Association association = Association::point;
  std::string field_name = "scalar";
  /// Tolerance and number of tets for cells of second and higher order, as in ReadOptions. For a mesh in parts they
  /// apply to the whole mesh, and the smallest `higher_order_tets` of all ranks is used.
  double higher_order_tolerance = default_higher_order_tolerance;
  std::uint64_t higher_order_tets = default_higher_order_tets;
  /// Only with `tets`: for each tet the number (uint64) of the cell of another mesh from which the tet was made. The
  /// tets of one cell are contiguous. If the array is empty, each tet is a cell of its own. write_mesh() writes these
  /// numbers; images do not depend on them.
  ArrayView original_cells{};
  /// Keeps the arrays alive as long as the data set needs them. If it is null, the caller must do so.
  std::shared_ptr<const void> owner;
};

/// A regular or rectilinear grid in the caller's memory: samples with i fastest, never copied.
struct GridArrays {
  GridGeometry geometry;
  ArrayView samples;            ///< numbers of samples as in geometry.samples(); not 64-bit integers
  double scale = 1, shift = 0;  ///< value = scale * sample + shift
  std::string field_name = "scalar";
  std::shared_ptr<const void> owner;  ///< as MeshArrays::owner
};

/// Options for converting the numbers of a preset or a file to extinction [1 / world unit] and linear colour.
struct TransferFunctionOptions {
  std::optional<double> unit_distance{};  ///< length, in world units, to which opacities refer; overrides the file's
  double opacity_scale = 1;               ///< factor of the extinction, >= 0
  bool display_colors = false;  ///< colours are used as in the file, without decoding them from sRGB, as in VTK
  bool rescale = false;         ///< stretch the values of a file over the field's range
  /// If given, presets, the default function and files are stretched over this range; low < high.
  std::optional<std::array<double, 2>> range{};
  /// Colours and opacities depend on the logarithm of the value. Values <= 0 are treated as the field's smallest
  /// positive value. A field without positive values causes an error.
  bool logarithmic = false;
  /// Pairs of a fraction of the range (0 to 1, ascending) and the opacity per unit distance there (0 to 1). Opacities
  /// are linear between them and replace the opacities of a preset or a colour map. Not allowed for files that contain
  /// extinctions.
  std::vector<std::array<double, 2>> opacity_points{};
  /// If true, files whose values are from 0 to 1 or from -1 to 1, like ParaView's presets, are stretched as with
  /// `rescale` if they would otherwise show almost nothing: if less than a hundredth of the field's range is within the
  /// file's range, or the reverse.
  bool rescale_presets = false;
  /// How images are rendered; used only for the warnings. Independent emission shows light without extinction, and in
  /// images with surfaces a transparent function may be intended.
  Emission emission = Emission::absorption;
  bool with_surfaces = false;
};

/// A mesh or a grid with one scalar field. The data are immutable and shared by all copies of a Dataset; several
/// threads and sessions may use them at the same time.
///
/// On several ranks, either each rank has the whole data set, or all ranks open it together and each has one part.
class TESSERA_EXPORT Dataset {
 public:
  /// Opens a file; several files are the pieces of one mesh. The beginning of the file determines its format; if it
  /// does not, the file's name does (docs/FORMATS.md). Throws Error(bad_input), with a message of one line, for a
  /// missing, truncated, malformed or empty file and for an unknown field, and Error(system_failure) if memory runs
  /// out.
  static Dataset open(const std::filesystem::path& file, const ReadOptions& options = {});
  static Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& options = {});
  /// Opens the files by all ranks of a communicator, which must also be the session's communicator. If the format
  /// allows it, each projector reads its own part; otherwise one rank reads the file and distributes the parts. Grids
  /// are scanned by all ranks together; their bricks are read when they are needed. `ranks` must be the same as for the
  /// session. Collective.
  static Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& options,
                      const Communicator& communicator, const RankSettings& ranks = {});

  /// Opens a file that has already been identified.
  static Dataset open(const InputFile& file, const ReadOptions& options = {});
  static Dataset open(const InputFile& file, const ReadOptions& options, const Communicator& communicator,
                      const RankSettings& ranks = {});

  /// Makes a data set from the caller's arrays. Throws Error(bad_input), which names the array and the position, if an
  /// array is invalid, and Error(bad_input) if no cell or no finite sample remains.
  static Dataset of(const MeshArrays& arrays);
  static Dataset of(const GridArrays& arrays);
  /// Makes a grid from samples that are read when they are needed. All of them are read once at the beginning to
  /// determine their range.
  static Dataset of(std::shared_ptr<const SampleSource> samples);
  /// Makes a data set from a mesh in parts, one per rank, as in a simulation. Every cell is on exactly one rank; there
  /// are no ghost cells. The part of a rank may be empty. Cells are numbered rank after rank. Collective. The session
  /// must use the same communicator; every rank projects its own part.
  static Dataset of_parts(const MeshArrays& part, const Communicator& communicator);

  /// Returns the selected part (tessera/selection.hpp) of a mesh that is whole on this rank. The result keeps the
  /// complete data set, which Session::verify() and Reference use to check clipped images. Throws Error(bad_input) for
  /// a grid, for one rank's part of a mesh, and if nothing remains.
  [[nodiscard]] Dataset selected(const Selection& selection) const;

  [[nodiscard]] bool is_mesh() const;
  [[nodiscard]] bool is_grid() const { return !is_mesh(); }

  /// Bounding box of the whole data set, on every rank.
  [[nodiscard]] const Box& bounds() const;
  /// Factors by which the file's axes were multiplied (ReadOptions::axis_scale).
  [[nodiscard]] const glm::dvec3& axis_scale() const;
  /// Smallest and largest value of the field, not counting blanks.
  [[nodiscard]] std::array<double, 2> range() const;
  [[nodiscard]] Association association() const;
  [[nodiscard]] const std::string& field_name() const;
  /// Whether the data set shows the shape of a mesh instead of a field (ReadOptions::shape).
  [[nodiscard]] bool shows_shape() const;
  /// The arrays of the file. For a data set made from the caller's arrays: the scalar array alone.
  [[nodiscard]] std::span<const FieldInfo> fields() const;
  /// Lines of text that report what was chosen or applied when the file was read, and what is unusual about the file.
  [[nodiscard]] std::span<const std::string> notes() const;
  /// Lines of text that report which contents of the file are drawn differently, without an error bound. Usually empty.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Number of time steps in the file. One of them was read. 1 if the data do not change with time.
  [[nodiscard]] std::size_t time_steps() const;
  /// The times of all steps of the file and the time of the step that was read, in the file's unit. The list is empty
  /// if the file does not state times.
  [[nodiscard]] std::span<const double> times() const;
  [[nodiscard]] std::optional<double> time() const;
  /// Names of the file's blocks (ReadOptions::blocks), including those that were not read.
  [[nodiscard]] std::span<const std::string> blocks() const;
  /// Names of surfaces in a mesh's file, such as side sets and patches. They are not part of the mesh;
  /// read_block_surface() reads them.
  [[nodiscard]] std::span<const std::string> surfaces() const;
  /// The file's format: "VTK XML unstructured grid", "NRRD", ...; "arrays" for the caller's arrays.
  [[nodiscard]] const std::string& format() const;
  /// Name of the data set in messages: the file's name or, for the caller's arrays, "mesh" or "grid".
  [[nodiscard]] const std::string& source() const;

  /// Counts of a mesh; zero for a grid.
  [[nodiscard]] std::uint64_t tet_count() const;
  [[nodiscard]] const MeshCounts& mesh_counts() const;
  [[nodiscard]] const HigherOrderCells& higher_order_cells() const;
  /// The tets that are rendered (on several ranks, by this rank), as float64 points and scalars and uint32 tets. The
  /// arrays belong to this data set and keep it alive. Throws Error(bad_input) for a grid.
  [[nodiscard]] MeshArrays mesh_arrays() const;
  /// Geometry of a grid. Throws Error(bad_input) for a mesh.
  [[nodiscard]] const GridGeometry& grid_geometry() const;
  [[nodiscard]] SampleType sample_type() const;
  /// value = scale * sample + shift; 1 and 0 for a mesh.
  [[nodiscard]] double scale() const;
  [[nodiscard]] double shift() const;
  [[nodiscard]] std::uint64_t blank_samples() const;

  /// The length, in world units, to which opacities refer if neither the file nor the caller states one. It is a tenth
  /// of the mean thickness of the data, so that the presets' ramps make an average ray 0.26 to 0.89 opaque. It is a
  /// twentieth of the diagonal for data without volume, and 1 for data without extent.
  [[nodiscard]] double default_unit_distance() const;
  /// The default view, which shows all of the data: z points up, and flat data are seen from above
  /// (tessera/default_view.hpp).
  [[nodiscard]] Camera default_camera(ImageSize size, ProjectionKind projection = ProjectionKind::orthographic) const;
  /// The default camera together with the image size, for Session::render().
  [[nodiscard]] View default_view(ImageSize size, ProjectionKind projection = ProjectionKind::orthographic) const;
  /// The requested view of all of the data. If `turning`, it is wide enough for every turn of orbit(). Throws the same
  /// errors as view_of_box().
  [[nodiscard]] Camera view(const ViewRequest& request, ImageSize size,
                            ProjectionKind projection = ProjectionKind::orthographic, bool turning = false) const;
  /// The anatomical axes, if a medical file states them.
  [[nodiscard]] BodyAxes body_axes() const;
  /// Returns a transfer function for this field's range. It is a preset ("viridis", "cool-warm:rise", ...), is read
  /// from a file, or is given as JSON text (is_json_text(); messages call the text `transfer_function`). If the
  /// argument is empty, the default function is chosen by how the field's values are distributed over the volume
  /// (docs/REFERENCE.md, "The first picture"); it is the same for any number of ranks and threads. The first call
  /// samples the field at about ten thousand places. The `warnings` of the result report what the function does not
  /// show. Throws Error(bad_input) with the file and line.
  [[nodiscard]] LoadedTransferFunction transfer_function(const std::string& file_or_preset = "",
                                                         const TransferFunctionOptions& options = {}) const;

  /// Finds overlapping cells, folds, unmatched faces, slivers and duplicates in a mesh that is whole on this rank.
  /// Throws Error(bad_input) for a grid and for one rank's part of a mesh. `progress` is called on the calling thread
  /// with the completed fraction, 0 to 1.
  [[nodiscard]] MeshCheck check(const CheckProgressFunction& progress = nullptr) const;

  /// Whether this data set and `other` are copies of one data set.
  [[nodiscard]] bool is_copy_of(const Dataset& other) const { return state_ == other.state_; }

  struct State;  ///< incomplete for callers

 private:
  friend struct StateAccess;
  explicit Dataset(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

/// Number of time steps in a mesh or grid file (ReadOptions::time_step); 1 if the data do not change with time. The
/// file is opened, with `options`, only if its format allows several steps. Throws the same errors as Dataset::open().
TESSERA_EXPORT std::size_t time_steps_of(const std::filesystem::path& file, const ReadOptions& options = {});

/// The times of the file's steps if it states them; otherwise the numbers of the steps, counted from 0.
TESSERA_EXPORT std::vector<double> times_of(const std::filesystem::path& file, const ReadOptions& options = {});
TESSERA_EXPORT std::vector<double> times_of(const InputFile& file, const ReadOptions& options = {});

/// The names of all presets' colours, the default first.
TESSERA_EXPORT std::vector<std::string> preset_names();

}  // namespace v0_1
}  // namespace tessera
