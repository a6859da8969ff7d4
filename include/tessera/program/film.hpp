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

/// Time steps from the first to the last, both included, counted from 0.
struct StepRange {
  std::size_t first = 0;
  std::optional<std::size_t> last{};  ///< none: the last that there is
  std::size_t stride = 1;             ///< at least 1; every so many-th
};

/// The pictures that a run is to make: each time step of the inputs in each view.
struct FilmPlan {
  std::vector<std::filesystem::path> inputs;  ///< one mesh, grid or time series; or several of the first two, as steps
  bool grids = false;                         ///< what the inputs are
  /// Steps of a time series or of the list of inputs; of one file the steps in it, of which it has `file_steps`. None:
  /// all of a series, and of a file the one that ReadOptions::time_step says.
  std::optional<StepRange> steps{};
  std::size_t file_steps = 1;
  std::vector<double> file_times{};  ///< when they are (Dataset::times()); none: their numbers
  /// A view or a list of views, a file or JSON itself (cameras_of()); empty: the default view.
  std::filesystem::path cameras;
  int orbit = 0;                  ///< frames of one turn of one view round its up axis; 0: none
  std::optional<ImageSize> size;  ///< wins over the camera file's
  /// At least one, several for one frame in several formats; of several frames with `%d` or `%0Nd` for their number.
  std::vector<std::filesystem::path> outputs;
  bool resume = false;  ///< frames whose pictures are all there count as finished
};

/// One picture of a plan, before any data is read.
struct FilmFrame {
  int number = 0;                ///< from 0; what %d in a name stands for
  std::size_t step = 0;          ///< of the time series; 0 without one
  TimeStep data;                 ///< that step
  std::optional<Camera> camera;  ///< none: the view that frames the data, known once it is read
  std::optional<double> turn;    ///< 0..1: of an orbit round the view's up axis
  ImageSize size;
  std::vector<std::filesystem::path> outputs;
  bool finished = false;  ///< resumed, and all its pictures exist: to be left alone

  /// The frame's view. `box` is the data's; of a time series the first step's, so that the view stands still. A camera
  /// of the plan is adjusted as `request` says, else the view is made as it says.
  [[nodiscard]] Camera view(const Box& box, ProjectionKind default_projection, const ViewRequest& request = {},
                            BodyAxes axes = BodyAxes::none) const;
  /// Whether all files of its step are.
  [[nodiscard]] bool is_there() const;
  /// Of a series' later steps, before they are read: throws Error(system_failure) if a file that plan_film() saw is
  /// gone.
  void require_still_there() const;
};

/// Whether the plan's input is a time series, be it of one step: several files, a name for several, or steps of one.
bool is_series(const FilmPlan& plan);

/// Whether what is shown of the plan's one file depends on how many steps it has: FilmPlan::file_steps is to be set.
bool takes_steps_of_file(const FilmPlan& plan);

/// The frames of a plan: all views of the first step, then of the second. Frame 0 is always of the first step. Throws
/// Error(bad_input) if an input that is to be read is not there, if several frames would share one name, if an orbit is
/// asked of several views, for steps that are not there, or for what cameras_of() refuses.
std::vector<FilmFrame> plan_film(const FilmPlan& plan);

/// The default of ReadOptions::field for several steps together; `steps` has each step's fields. Each array counts as
/// in the step where its range is widest; arrays that a step lacks are left out. The name has `point:` or `cell:`
/// before it, without `smooth`. Empty if no array varies but labels.
std::string field_of_steps(std::span<const std::vector<FieldInfo>> steps, const ReadOptions& options);

/// How later steps of a time series are read: their field and axis scale are those that were chosen for the first step.
/// A field that varies in one step and not in the next would else make the film jump to another.
ReadOptions read_of_later_steps(ReadOptions options, const Dataset& first);

/// Before any reading or rendering: can all pictures of the frames that are not finished be written, and the `more`
/// files beside them? Throws Error(bad_input) for an unknown extension, a folder that is missing or closed to us, two
/// outputs of one name, or an output that is one of the frames' data or of the `inputs` (empty ones count for nothing);
/// Error(system_failure) if a picture cannot fit in this machine's memory.
void check_film_outputs(std::span<const FilmFrame> frames, std::span<const std::filesystem::path> more,
                        std::span<const std::filesystem::path> inputs);

}  // namespace v0_1
}  // namespace tessera
