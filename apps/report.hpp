#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/frame_list.hpp"
#include "apps/render_options.hpp"
#include "apps/verify.hpp"
#include "frame/roles.hpp"
#include "tessera/dataset.hpp"
#include "tessera/statistics.hpp"
#include "tessera/transfer_function.hpp"

/// What a run chose and did, as JSON (--report, info --json) and as the one line on stderr: of meshes and grids alike.
namespace tessera::apps {

/// What happened to one frame that was rendered, of all ranks together.
struct FrameRecord {
  scene::Camera camera;
  FrameStatistics statistics;
  std::vector<double> frame_ms;  ///< one a repetition
  std::optional<Verification> verification;
};

/// What lines and reports say of a data set, kept when it is gone: the notes in the program's words.
struct Description {
  explicit Description(const Dataset& data);

  bool is_mesh;
  std::string format, field_name;
  Association association;
  Box box;
  std::array<double, 2> range;
  std::vector<FieldInfo> fields;
  std::vector<std::string> notes;
  MeshCounts counts;      ///< meshes
  GridGeometry geometry;  ///< grids, and so on
  SampleType type{};
  double scale = 1, shift = 0;
  std::uint64_t blanks = 0;
};

/// File, format, what it is made of, bounds, chosen field, all fields, notes: the report's "mesh" or "volume".
nlohmann::ordered_json data_json(const std::filesystem::path& input, const Description& data);

/// Name, unit distance and its source, knots.
nlohmann::ordered_json transfer_function_json(const LoadedTransferFunction& loaded);

/// A view in the words of camera files, so that it can be cut out and used as one.
nlohmann::ordered_json view_json(const scene::Camera& camera, scene::ImageSize size);

/// What the settings and command line chose but for data, view and transfer function.
nlohmann::ordered_json method_json(const RenderOptions& options, int ranks);

/// The shape of a job that renders a mesh.
nlohmann::ordered_json job_json(const RenderOptions& options, int ranks, const frame::Roles& roles,
                                const Settings& settings);

/// A frame's number, pictures, view, times, counters, balance and verification; without a record, that it was skipped.
nlohmann::ordered_json frame_json(const RenderOptions& options, const Frame& frame, const FrameRecord* record);

/// `accurate`, `backface`, ...: as --balance has it. `auto`, `exact`, ...: as --integrator. `runs`: as --exchange.
const char* balance_word(Balance balance);
const char* method_word(volume::Method method);
const char* exchange_word(Exchange exchange);

/// `18 kept of 20: 1 ghost and 1 NaN dropped`
std::string cells_line(const MeshCounts& counts);
/// `256x256x128 uint8 samples, 12 blank`
std::string samples_line(const Description& grid);
std::string view_line(const scene::Camera& camera);
std::string transfer_function_line(const LoadedTransferFunction& loaded);

/// `frame 12 of 50: mesh_0012.vtu, 842113 tets projected, 512 ms`: one a frame of a run of several.
std::string frame_line(const RenderOptions& options, const std::vector<Frame>& frames, const Frame& frame,
                       const FrameRecord& record);

/// The one line of a run, after its first frame: what was read, chosen and culled, and how long the frame took.
std::string run_line(const RenderOptions& options, const Description& data, const LoadedTransferFunction& loaded,
                     const std::vector<Frame>& frames, const Frame& first, const FrameRecord& record);

/// (largest - least) / mean: how unevenly work is shared; 0 if there is none.
double deviation(const std::vector<double>& work);

}  // namespace tessera::apps
