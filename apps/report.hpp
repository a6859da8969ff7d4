#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/frame_list.hpp"
#include "apps/mesh_input.hpp"
#include "apps/render_options.hpp"
#include "apps/verify.hpp"
#include "io/transfer_function_file.hpp"

/// What a run chose and did, as JSON (--report, info --json) and as the one line on stderr.
namespace tessera::apps {

/// What happened to one frame that was rendered.
struct FrameRecord {
  scene::Camera camera;
  frame::FrameStatistics statistics;
  std::vector<double> frame_ms;  ///< one a repetition
  std::optional<reference::Verification> verification;
};

/// File, format, cells, points, bounds, chosen field, all fields, notes.
nlohmann::ordered_json mesh_json(const std::filesystem::path& input, const MeshSummary& mesh);

/// Name, unit distance and its source, knots.
nlohmann::ordered_json transfer_function_json(const colormaps::LoadedTransferFunction& loaded);

/// A view in the words of camera files, so that it can be cut out and used as one.
nlohmann::ordered_json view_json(const scene::Camera& camera, scene::ImageSize size);

/// What the settings and command line chose but for mesh, view and transfer function.
nlohmann::ordered_json method_json(const RenderOptions& options);

/// A frame's number, pictures, view, times, counters and verification; without a record, that it was skipped.
nlohmann::ordered_json frame_json(const Frame& frame, const FrameRecord* record);

/// `18 kept of 20: 1 ghost and 1 NaN dropped`
std::string cells_line(const io::MeshCounts& counts);
std::string view_line(const scene::Camera& camera);
std::string transfer_function_line(const colormaps::LoadedTransferFunction& loaded);

/// `frame 12 of 50: mesh_0012.vtu, 842113 tets projected, 512 ms`: one a frame of a run of several.
std::string frame_line(const RenderOptions& options, const std::vector<Frame>& frames, const Frame& frame,
                       const FrameRecord& record);

/// The one line of a run, after its first frame: what was read, chosen and culled, and how long the frame took.
std::string run_line(const RenderOptions& options, const MeshSummary& mesh,
                     const colormaps::LoadedTransferFunction& loaded, const std::vector<Frame>& frames,
                     const Frame& first, const FrameRecord& record);

}  // namespace tessera::apps
