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

/// A range of time steps, counted from 0. Both ends are included.
struct StepRange {
  std::size_t first = 0;
  std::optional<std::size_t> last{};  ///< none: the last step of the input
  std::size_t stride = 1;             ///< at least 1
};

/// The images that a run renders: each time step of the inputs in each view.
struct FilmPlan {
  std::vector<std::filesystem::path> inputs;  ///< one mesh, grid or time series; or several meshes or grids, each a
                                              ///< time step
  bool grids = false;                         ///< whether the inputs are grids
  std::vector<TimeStep> series{};  ///< the steps of the only input, if it is a time series (read_time_series())
  /// The steps to render: steps of a time series, inputs of a list, or steps in a single file (`file_steps` is their
  /// number). None: all steps of a series or list; for a single file, the step of ReadOptions::time_step.
  std::optional<StepRange> steps{};
  std::size_t file_steps = 1;
  std::vector<double> file_times{};  ///< times of the file's steps (Dataset::times()); empty: the numbers of the steps
                                     ///< are used
  /// The name of a file, or JSON text, with one or several views (cameras_of()). Empty: the default view.
  std::filesystem::path cameras;
  int orbit = 0;                  ///< number of frames of one turn of the view about its up axis; 0: no turn
  std::optional<ImageSize> size;  ///< image size; overrides the size in the camera file
  /// At least one name. If there are several, each frame is written to all of them, in their formats. If there are
  /// several frames, names contain `%d` or `%0Nd`, which is replaced by the number of the frame.
  std::vector<std::filesystem::path> outputs;
  bool resume = false;  ///< frames whose images all exist are not rendered again
};

/// One frame of a plan, before any data are read.
struct FilmFrame {
  int number = 0;                ///< number from 0, which replaces %d in a name
  std::size_t step = 0;          ///< number of the step in the time series; 0 without a series
  TimeStep data;                 ///< the files of the step
  std::optional<Camera> camera;  ///< none: the view that frames the data, which is known after they are read
  std::optional<double> turn;    ///< position in an orbit about the view's up axis, 0 to 1; none: not an orbit
  ImageSize size;
  std::vector<std::filesystem::path> outputs;
  bool finished = false;  ///< the run is resumed and all images of the frame exist: the frame is not rendered again

  /// Returns the frame's view. `box` is the bounding box of the data or, for a time series, of its first step, so that
  /// the view does not move. If the plan has a camera, `request` adjusts it; otherwise `request` determines the view.
  [[nodiscard]] Camera view(const Box& box, ProjectionKind default_projection, const ViewRequest& request = {},
                            BodyAxes axes = BodyAxes::none) const;
  /// Whether all files of the frame's step exist.
  [[nodiscard]] bool is_there() const;
  /// Called for later steps of a series before they are read: throws Error(system_failure) if a file that plan_film()
  /// found no longer exists.
  void require_still_there() const;
};

/// Whether the plan's input is a time series, possibly with one step: several files, a name that denotes several files,
/// or the steps of one file.
bool is_series(const FilmPlan& plan);

/// Whether the plan has a single file and depends on the number of steps in the file, so that FilmPlan::file_steps must
/// be set.
bool takes_steps_of_file(const FilmPlan& plan);

/// Returns the frames of a plan: all views of the first step, then all views of the second step, and so on. Frame 0
/// always shows the first step. Throws Error(bad_input) if a required input is missing, if several frames would have
/// the same name, if several views have an orbit, or if a step does not exist; also throws the errors of cameras_of().
std::vector<FilmFrame> plan_film(const FilmPlan& plan);

/// Chooses the default of ReadOptions::field for several steps together. `steps` contains the fields of each step. The
/// widest range that an array has in any step is used; arrays that do not exist in all steps are ignored. The returned
/// name has the prefix `point:` or `cell:`, unless ReadOptions::smooth is set. Empty if no array varies except labels.
std::string field_of_steps(std::span<const std::vector<FieldInfo>> steps, const ReadOptions& options);

/// Returns the options for later steps of a time series: field and axis scale are those chosen for the first step.
/// Otherwise a film could change to another field at a step, if a field varies only in some steps.
ReadOptions read_of_later_steps(ReadOptions options, const Dataset& first);

/// For use before reading or rendering: checks that all images of the unfinished frames and the files `more` can be
/// written. Throws Error(bad_input) for an unknown extension, for a directory that is missing or not writable, for two
/// outputs with the same name, and for an output that is a data file of the frames or one of the `inputs` (empty names
/// are ignored). Throws Error(system_failure) if an image does not fit in this machine's memory.
void check_film_outputs(std::span<const FilmFrame> frames, std::span<const std::filesystem::path> more,
                        std::span<const std::filesystem::path> inputs);

}  // namespace v0_1
}  // namespace tessera
