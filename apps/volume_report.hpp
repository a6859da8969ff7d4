#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/frame_list.hpp"
#include "apps/render_options.hpp"
#include "apps/verify.hpp"
#include "io/transfer_function_file.hpp"
#include "io/volume_reader.hpp"
#include "volume/image_split.hpp"

/// What the rendering of a volume chose and did: the report's JSON and the lines on stderr.
namespace tessera::apps {

/// What happened to one frame that was rendered, of all ranks together.
struct VolumeFrameRecord {
  scene::Camera camera;
  volume::RenderStatistics statistics;
  std::uint64_t deep_samples = 0;  ///< of the deep picture, if one was asked for
  std::vector<double> frame_ms;    ///< one a repetition
  std::optional<reference::Verification> verification;
  volume::ImageSplit split;
  std::vector<std::uint64_t> samples;  ///< of each rank
  std::vector<double> cpu_seconds;     ///< of each rank
};

/// `accurate`, `backface`, ...: as --balance has it.
const char* balance_word(frame::Balance balance);
/// `auto`, `exact`, ...: as --integrator has it.
const char* method_word(volume::Method method);

/// What the settings and command line chose but for volume, view and transfer function.
nlohmann::ordered_json volume_method_json(const RenderOptions& options, int ranks);

/// A frame's number, pictures, view, times, counters, balance and verification; without a record, that it was skipped.
nlohmann::ordered_json volume_frame_json(const RenderOptions& options, const Frame& frame,
                                         const VolumeFrameRecord* record);

/// The one line of a run, after its first frame.
std::string volume_run_line(const RenderOptions& options, const io::VolumeFile& file,
                            const colormaps::LoadedTransferFunction& loaded, const std::vector<Frame>& frames,
                            const Frame& first, const VolumeFrameRecord& record);

/// `frame 12 of 50: 31415926 voxels visited, 512 ms`: one a frame of a run of several.
std::string volume_frame_line(const RenderOptions& options, const std::vector<Frame>& frames, const Frame& frame,
                              const VolumeFrameRecord& record);

/// (largest - least) / mean: how unevenly work is shared; 0 if there is none.
double deviation(const std::vector<double>& work);

}  // namespace tessera::apps
