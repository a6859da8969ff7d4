// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "tessera/camera.hpp"
#include "tessera/dataset.hpp"
#include "tessera/default_view.hpp"
#include "tessera/time_series.hpp"

namespace tessera {
inline namespace v0_1 {

/// A range of time steps, both ends included, counted from 0.
struct StepRange {
  std::size_t first = 0;
  std::optional<std::size_t> last{};  ///< none: the last one in the input
  std::size_t stride = 1;             ///< at least 1
};

/// The images that a run makes: each time step of the inputs in each view.
struct FilmPlan {
  std::vector<std::filesystem::path> inputs;  ///< one mesh, grid or time series; or several meshes or grids, as steps
  bool grids = false;                         ///< whether the inputs are grids
  /// Steps of a time series or of the list of inputs; for a single file its own steps (`file_steps` is their number).
  /// None: all of a series; for a file the step of ReadOptions::time_step.
  std::optional<StepRange> steps{};
  std::size_t file_steps = 1;
  std::vector<double> file_times{};  ///< the times of these steps (Dataset::times()); empty: their numbers
  /// A view or a list of views, as a file or as JSON text (cameras_of()); empty: the default view.
  std::filesystem::path cameras;
  int orbit = 0;                  ///< frames of one turn of one view about its up axis; 0: none
  std::optional<ImageSize> size;  ///< overrides that of the camera file
  /// At least one; several write one frame in several formats; for several frames with `%d` or `%0Nd` for their number.
  std::vector<std::filesystem::path> outputs;
  bool resume = false;  ///< frames whose images all exist count as finished
};

/// One frame of a plan, before any data are read.
struct FilmFrame {
  int number = 0;                ///< from 0; replaces %d in a name
  std::size_t step = 0;          ///< of the time series; 0 without one
  TimeStep data;                 ///< that step
  std::optional<Camera> camera;  ///< none: the view that frames the data, known once they are read
  std::optional<double> turn;    ///< 0..1: position in an orbit about the view's up axis
  ImageSize size;
  std::vector<std::filesystem::path> outputs;
  bool finished = false;  ///< resumed, and all its images exist: it is not rendered again

  /// The frame's view. `box` is that of the data, or of the first step of a time series, so that the view does not
  /// move. A camera of the plan is adjusted by `request`; otherwise `request` determines the view.
  [[nodiscard]] Camera view(const Box& box, ProjectionKind default_projection, const ViewRequest& request = {},
                            BodyAxes axes = BodyAxes::none) const;
  /// Whether all files of its step exist.
  [[nodiscard]] bool is_there() const;
  /// For later steps of a series, before they are read: throws Error(system_failure) if a file that plan_film() found
  /// is gone.
  void require_still_there() const;
};

/// Whether the plan's input is a time series, even with one step: several files, a name for several, or steps of one
/// file.
bool is_series(const FilmPlan& plan);

/// Whether the result for the plan's one file depends on the number of its steps, so that FilmPlan::file_steps must be
/// set.
bool takes_steps_of_file(const FilmPlan& plan);

/// The frames of a plan: all views of the first step, then of the second. Frame 0 is always of the first step. Throws
/// Error(bad_input) if a required input is missing, if several frames would have one name, if several views have an
/// orbit, for steps that do not exist, or for what cameras_of() refuses.
std::vector<FilmFrame> plan_film(const FilmPlan& plan);

/// The default of ReadOptions::field for several steps together; `steps` has each step's fields. Each array counts with
/// its widest range in any step; arrays that a step lacks are ignored. The name has the prefix `point:` or `cell:`,
/// without `smooth`. Empty if no array except labels varies.
std::string field_of_steps(std::span<const std::vector<FieldInfo>> steps, const ReadOptions& options);

/// Options for later steps of a time series: field and axis scale are those chosen for the first step. Otherwise the
/// film would jump to another field if one varies in some steps only.
ReadOptions read_of_later_steps(ReadOptions options, const Dataset& first);

/// For use before reading or rendering: checks that all images of the unfinished frames, and the `more` files, can be
/// written. Throws Error(bad_input) for an unknown extension, a directory that is missing or not writable, two outputs
/// of one name, or an output that is one of the frames' data or of the `inputs` (empty names are ignored);
/// Error(system_failure) if an image does not fit in this machine's memory.
void check_film_outputs(std::span<const FilmFrame> frames, std::span<const std::filesystem::path> more,
                        std::span<const std::filesystem::path> inputs);

}  // namespace v0_1
}  // namespace tessera
