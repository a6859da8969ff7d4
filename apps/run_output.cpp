#include "apps/run_output.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/atomic_file.hpp"
#include "io/image_deep_exr.hpp"
#include "scene/threads.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string frame_ms_line(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const std::size_t middle = times.size() / 2;
  const double median = times.size() % 2 == 1 ? times[middle] : (times[middle - 1] + times[middle]) / 2;
  return fmt::format("frame_ms median {:.3f} min {:.3f}", median, times.front());
}

void write_json(const Json& json, const std::filesystem::path& path) {
  io::AtomicFile file(path);
  // A file name need not be UTF-8; JSON must.
  file.write(json.dump(2, ' ', false, Json::error_handler_t::replace));
  file.write("\n");
  file.commit();
}

RunOutput::RunOutput(const RenderOptions& options, const std::vector<Frame>& frames)
    : options_(options),
      frames_(frames),
      progress_(options.progress, frames.size()),
      report_{{"program", "tessera"}, {"version", TESSERA_VERSION}, {"method", method_json(options)}},
      frame_reports_(!options.report.empty()) {}

void RunOutput::describe(MeshSummary mesh, colormaps::LoadedTransferFunction transfer_function) {
  mesh_ = std::move(mesh);
  transfer_function_ = std::move(transfer_function);
}

void RunOutput::skip(const Frame& frame) {
  if (frame_reports_.kept()) frame_reports_.add(frame_json(frame, nullptr));
  progress_.update(++done_, rendered_);
}

void RunOutput::add(const Frame& frame, const FrameRecord& record) {
  if (frame_reports_.kept()) frame_reports_.add(frame_json(frame, &record));
  if (rendered_ == 0 && !options_.quiet) {
    progress_.clear();
    fmt::print(stderr, "{}\n", run_line(options_, *mesh_, *transfer_function_, frames_, frame, record));
  }
  if (frames_.size() > 1 && !options_.quiet) {
    progress_.clear();
    fmt::print(stderr, "{}\n", frame_line(options_, frames_, frame, record));
  }
  if (options_.repeat > 0) fmt::print("{}\n", frame_ms_line(record.frame_ms));
  if (record.verification) {
    fmt::print("{}\n", verification_line(*record.verification, frame.number));
    met_ = met_ && record.verification->met();
  }
  progress_.update(++done_, ++rendered_);
}

scene::ExitCode RunOutput::finish() {
  progress_.clear();
  if (mesh_) {
    report_["mesh"] = mesh_json(options_.input, *mesh_);
    report_["transfer_function"] = transfer_function_json(*transfer_function_);
  } else if (!options_.quiet) {
    fmt::print(stderr, "{}: all {} frames are there already, nothing rendered\n", options_.input.string(),
               frames_.size());
  }
  if (!options_.report.empty()) frame_reports_.write(report_, options_.report);
  return met_ ? scene::ExitCode::complete : scene::ExitCode::accuracy_not_met;
}

void write_pictures(const scene::Image& image, const scene::DeepImage& deep, const Frame& frame,
                    const RenderOptions& options) {
  try {
    for (const auto& output : frame.outputs) {
      if (io::is_deep_name(output))
        io::write_deep_exr(deep, output);
      else
        io::write_image(image, output, options.image);
    }
  } catch (const io::OutputFault& fault) {
    throw fault.since_changed();
  }
}

io::TraceRun trace_run(const RenderOptions& options, std::uint64_t tets, const Frame& frame, std::size_t rendered) {
  const Json method = method_json(options);
  io::TraceRun traced;
  traced.version = TESSERA_VERSION;
  traced.input = options.input.string();
  traced.tets = tets;
  traced.frames = static_cast<int>(rendered) * std::max(options.repeat, 1);
  traced.width = frame.size.width;
  traced.height = frame.size.height;
  traced.threads = scene::threads_for(options.settings.threads);
  traced.rasterizer = method.value("rasterizer", "planes");
  traced.integrator = method.at("integrator");
  return traced;
}

}  // namespace tessera::apps
