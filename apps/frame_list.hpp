#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/render_options.hpp"
#include "io/time_series.hpp"
#include "scene/camera.hpp"

namespace tessera::apps {

/// One picture that a run makes, before the mesh is read.
struct Frame {
  int number = 0;                       ///< from 0; what %d in a name stands for
  std::size_t step = 0;                 ///< of the time series; 0 without one
  io::TimeStep mesh;                    ///< that step
  std::optional<scene::Camera> camera;  ///< none: the view that frames the mesh, known once it is read
  std::optional<double> turn;           ///< 0..1: of an orbit round the view's up axis
  scene::ImageSize size;
  std::vector<std::filesystem::path> outputs;
  bool finished = false;  ///< --resume, and all its pictures exist: left alone
};

/// The frames of a run: one a view of the camera file, or --orbit's of one view; of a time series all these of the
/// first step, then of the second. Frame 0 is always of the first step.
/// Throws scene::Error(bad_input) if a mesh that is to be read is not there, if several frames would share one name, if
/// an orbit is asked of several views, or for what io::read_cameras refuses.
std::vector<Frame> list_frames(const RenderOptions& options);

/// Of a series' later steps, before they are read: throws scene::Error(system_failure) if a file that list_frames() saw
/// is gone.
void require_still_there(const Frame& frame);

/// Whether the run's input is a time series, be it of one step.
bool is_series(const RenderOptions& options);

/// The frame's view. `box` is the mesh's; of a time series the first step's, so that the view stands still.
scene::Camera view_of(const Frame& frame, const scene::Box& box, scene::ProjectionKind default_projection);

/// A name with its first `%d` or `%0Nd` (as in printf) replaced by a number; nothing if it has none. Other text, other
/// % too, stays.
std::optional<std::string> numbered_name(const std::string& pattern, int number);

}  // namespace tessera::apps
