// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/reports.hpp"
#include "tessera/program/method_words.hpp"
#include "tessera/program/render_options.hpp"
#include "tessera/statistics.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/verification.hpp"

/// Descriptions of what a run chose and did, for meshes and grids: as JSON (--report, info --json) and as one line on
/// stderr.
namespace tessera::apps {

/// Results of one rendered frame, for all ranks together.
struct FrameRecord {
  Camera camera;
  FrameStatistics statistics;
  std::vector<double> frame_ms;  ///< times of all repetitions
  std::optional<Verification> verification;
};

/// The description of a data set for lines and reports. Its notes contain names of options instead of settings.
analysis::Description described(const Dataset& data);

/// A note that states how much the division of higher-order cells into tets changes pixels, and whether this is more
/// than `accuracy`.
std::string higher_order_note(double error, double accuracy);

/// The method as chosen by settings and command line: everything except data, view and transfer function.
nlohmann::ordered_json method_json(const RenderOptions& options, int ranks);

/// The layout of a job that renders a mesh.
nlohmann::ordered_json job_json(const RenderOptions& options, int ranks, const Roles& roles);

/// The parts of frames that were computed in double precision: ray segments of meshes, or pixels of grids.
struct InDoublePrecision {
  std::uint64_t parts = 0, all = 0;
};
InDoublePrecision in_double_precision(const FrameStatistics& statistics, bool is_grid);

/// A frame's number, images, view, times, counters, balance and verification. Without a record, the entry states that
/// the frame was skipped.
nlohmann::ordered_json frame_json(const RenderOptions& options, const FilmFrame& frame, const FrameRecord* record);

/// `18 of 20 cells kept as 36 tets, 1 ghost dropped, 1 tangled kept`
std::string cells_line(const MeshCounts& counts);
/// `256x256x128 uint8 samples, 12 blank`
std::string samples_line(const analysis::Description& grid);
std::string view_line(const Camera& camera);
std::string transfer_function_line(const LoadedTransferFunction& loaded);

/// `frame 12 of 50: mesh_0012.vtu, 842113 tets projected, 512 ms`: one per frame of a run with several.
std::string frame_line(const RenderOptions& options, const std::vector<FilmFrame>& frames, const FilmFrame& frame,
                       const FrameRecord& record);

/// The line that a run prints after its first frame: what was read, chosen and culled, and the time of the frame.
std::string run_line(const RenderOptions& options, const analysis::Description& data,
                     const LoadedTransferFunction& loaded, const std::vector<FilmFrame>& frames, const FilmFrame& first,
                     const FrameRecord& record);

/// `verify frame 3: 1000 pixels, max 1.2e-06 rms 2.1e-08, worst at (512, 33), 0 excused; bound 2e-05 met; worst: edge;
/// chosen: 334 random, 223 edge, 222 tie, 221 step`
std::string verification_line(const Verification& verification, int frame_number);

}  // namespace tessera::apps
