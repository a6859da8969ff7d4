#include "apps/distributed_render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "apps/frame_list.hpp"
#include "apps/output_check.hpp"
#include "apps/run_output.hpp"
#include "exchange/wire.hpp"
#include "frame/distributed.hpp"
#include "frame/distributed_mesh.hpp"
#include "frame/verify.hpp"
#include "projection/segment_tuple.hpp"
#include "scene/trace.hpp"

namespace tessera::apps {
namespace {

using exchange::Bytes;

std::string process_name(const frame::Roles& roles, int rank) {
  const bool projects = roles.projects(rank), composites = roles.composites(rank);
  return fmt::format("rank {} {}", rank,
                     projects && composites ? "projector + compositor"
                     : projects             ? "projector"
                                            : "compositor");
}

const char* word(frame::Exchange exchange) { return exchange == frame::Exchange::runs ? "runs" : "segments"; }

const char* word(projection::PartitionKind kind) {
  switch (kind) {
    case projection::PartitionKind::file:
      return "file";
    case projection::PartitionKind::random:
      return "random";
    case projection::PartitionKind::curve:
      break;
  }
  return "curve";
}

/// One rank's share of a run.
class RankRun {
 public:
  RankRun(const RenderOptions& options, exchange::Transport& transport)
      : options_(options),
        transport_(transport),
        roles_(frame::assign_roles(transport.size(), options.projectors, options.compositors)),
        writes_(transport.rank() == roles_.assembler()),
        frames_(list_frames(options)),
        compositing_(projecting_, scene::TraceRole::compositor),
        output_(writer_options(), frames_) {}

  scene::ExitCode run() {
    agree_on_finished_frames();
    if (std::any_of(frames_.begin(), frames_.end(), [](const Frame& frame) { return !frame.finished; }))
      render();
    else if (writes_)
      for (const Frame& frame : frames_) output_.skip(frame);
    if (!options_.timing.empty()) {
      transport_.trace_to(nullptr, nullptr);
      io::TraceRun traced = trace_run(options_, tets_, frames_.front(), output_.rendered());
      traced.ranks = transport_.size();
      traced.projectors = static_cast<int>(roles_.projectors.size());
      traced.compositors = static_cast<int>(roles_.compositors.size());
      traced.exchange = word(options_.exchange);
      write_rank_traces(transport_, roles_.assembler(), projecting_, process_name(roles_, transport_.rank()), traced,
                        options_.timing);
    }
    Bytes code(1);
    if (writes_) code[0] = static_cast<std::byte>(output_.finish());
    return static_cast<scene::ExitCode>(exchange::broadcast(transport_, roles_.assembler(), code)[0]);
  }

 private:
  /// Only one rank shows progress.
  const RenderOptions& writer_options() {
    if (!writes_) quiet_.progress = false;
    return quiet_;
  }

  /// The writing rank's view of the disk holds for all.
  void agree_on_finished_frames() {
    if (writes_) check_outputs(options_, frames_);
    Bytes finished(frames_.size());
    for (std::size_t i = 0; i < frames_.size(); ++i) finished[i] = std::byte{frames_[i].finished};
    finished = exchange::broadcast(transport_, roles_.assembler(), std::move(finished));
    for (std::size_t i = 0; i < frames_.size(); ++i) frames_[i].finished = finished[i] != std::byte{0};
  }

  /// Of the whole mesh, where the rasterizer wants to know: the longest of all ranks'. Collective.
  float longest_edge(const scene::TetMesh& part) {
    if (options_.settings.rasterizer != frame::Rasterizer::scanline) return 0;
    float longest = projection::longest_edge(part);
    Bytes mine;
    exchange::append(mine, longest);
    for (const Bytes& other : exchange::gather_all(transport_, std::move(mine)))
      longest = std::max(longest, exchange::RecordReader(other).take<float>());
    return longest;
  }

  void render();
  void take(const frame::FinishedFrame& finished);
  reference::Verification verify_frame(const Frame& frame, const scene::Image& image, const scene::Camera& camera);

  const RenderOptions& options_;
  RenderOptions quiet_ = options_;
  exchange::Transport& transport_;
  frame::Roles roles_;
  bool writes_;
  std::vector<Frame> frames_;
  scene::Trace projecting_{scene::TraceRole::projector};
  scene::Trace compositing_;
  RunOutput output_;

  std::uint64_t tets_ = 0;
  colormaps::LoadedTransferFunction loaded_;
  std::vector<std::size_t> job_frames_;  ///< frame of each job
  std::vector<std::size_t> meshes_;      ///< first frame of each mesh of the jobs
  std::vector<frame::FrameJob> jobs_;
  std::size_t next_to_report_ = 0;
  std::vector<double> frame_ms_;            ///< of the frame at hand
  std::optional<io::MeshFile> whole_mesh_;  ///< for --verify
  std::size_t whole_step_ = 0;
  io::MeshOptions later_options_;  ///< of the steps after the first
};

void RankRun::render() {
  const bool timed = !options_.timing.empty();
  scene::Trace* trace = timed ? &projecting_ : nullptr;
  if (timed) transport_.trace_to(&projecting_, &compositing_);

  // Of a time series the first step, which gives transfer function and view, even if none of its frames is to be made.
  frame::DistributedMesh mesh =
      frame::read_distributed(transport_, frames_.front().mesh.files, options_.mesh, options_.partition,
                              roles_.projectors, options_.settings.threads, trace);
  later_options_ = options_of_later_steps(options_.mesh, mesh.description);
  const MeshSummary summary = summary_of(mesh.description, mesh.facts);
  tets_ = summary.facts.tets;
  loaded_ = transfer_function_of(summary.facts, options_);
  if (options_.exchange == frame::Exchange::segments && tets_ > 0xffffffffull)
    throw scene::bad_input(fmt::format("--exchange segments: {} tets are more than 2^32; use runs", tets_));
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (frames_[i].finished) continue;
    if (meshes_.empty() || frames_[meshes_.back()].step != frames_[i].step) meshes_.push_back(i);
    const scene::Camera camera = view_of(frames_[i], summary.facts.box, options_.projection);
    for (int repetition = 0; repetition < std::max(options_.repeat, 1); ++repetition) {
      jobs_.push_back({camera, frames_[i].size, meshes_.size() - 1});
      job_frames_.push_back(i);
    }
  }

  frame::DistributedSettings settings;
  settings.render = options_.settings;
  settings.roles = roles_;
  settings.exchange = options_.exchange;
  settings.compositing_on = options_.compositing_on;
  settings.deep = options_.deep;
  settings.frames_in_flight = options_.repeat > 0 ? 1 : options_.frames_in_flight;  // a time is of one frame alone
  settings.tile_seed = options_.tile_seed;
  settings.projecting = trace;
  settings.compositing = timed ? &compositing_ : nullptr;

  if (writes_) {
    output_.describe(summary, loaded_);
    output_.note("job", {{"ranks", transport_.size()},
                         {"projectors", roles_.projectors},
                         {"compositors", roles_.compositors},
                         {"exchange", word(options_.exchange)},
                         {"partition", word(options_.partition.kind)},
                         {"frames_in_flight", settings.frames_in_flight},
                         {"seed", options_.tile_seed}});
  }
  frame::render_distributed(
      transport_, settings, jobs_, loaded_.function,
      [&](std::size_t m) {
        const Frame& first = frames_[meshes_[m]];
        if (first.step != 0) {
          require_still_there(first);
          mesh = {};  // the last one's memory before the next one's
          mesh = frame::read_distributed(transport_, first.mesh.files, later_options_, options_.partition,
                                         roles_.projectors, options_.settings.threads, trace);
        }
        const float edge = longest_edge(mesh.part.mesh);
        frame::order_corners(mesh.part.mesh, settings.render);
        auto part = std::make_shared<const scene::TetMesh>(std::move(mesh.part.mesh));
        return frame::ProjectorMesh{*part,
                                    part,
                                    nullptr,
                                    std::move(mesh.part.global_tet),
                                    diagonal(mesh.facts.box),
                                    mesh.facts.box,
                                    mesh.facts.scalar_range,
                                    edge};
      },
      [&](const frame::FinishedFrame& finished) { take(finished); });
  for (; writes_ && next_to_report_ < frames_.size(); ++next_to_report_) output_.skip(frames_[next_to_report_]);
}

reference::Verification RankRun::verify_frame(const Frame& frame, const scene::Image& image,
                                              const scene::Camera& camera) {
  const scene::TraceScope scope(options_.timing.empty() ? nullptr : &compositing_, "verify");
  // The reference looks at every cell, so this rank alone reads all of them.
  if (!whole_mesh_ || whole_step_ != frame.step) {
    whole_mesh_.reset();
    whole_mesh_ = read_input(frame.mesh.files, frame.step == 0 ? options_.mesh : later_options_);
    whole_step_ = frame.step;
  }
  return frame::verify(image, whole_mesh_->mesh, camera, loaded_.function, options_.settings,
                       static_cast<std::size_t>(options_.verify));
}

/// On the writing rank, for every repetition of every frame in order.
void RankRun::take(const frame::FinishedFrame& finished) {
  const std::size_t at = job_frames_[finished.frame];
  frame_ms_.push_back(finished.frame_ms);
  if (finished.frame + 1 < jobs_.size() && job_frames_[finished.frame + 1] == at) return;
  const Frame& frame = frames_[at];
  {
    const scene::TraceScope scope(options_.timing.empty() ? nullptr : &compositing_, "write",
                                  static_cast<std::int32_t>(finished.frame));
    write_pictures(finished.image, finished.deep, frame, options_);
  }
  FrameRecord record;
  record.camera = jobs_[finished.frame].camera;
  record.statistics = finished.statistics;
  record.frame_ms = std::exchange(frame_ms_, {});
  if (options_.verify > 0) record.verification = verify_frame(frame, finished.image, record.camera);
  for (; next_to_report_ < at; ++next_to_report_) output_.skip(frames_[next_to_report_]);
  output_.add(frame, record);
  next_to_report_ = at + 1;
}

}  // namespace

scene::ExitCode render_on_ranks(const RenderOptions& options, exchange::Transport& transport) {
  return RankRun(options, transport).run();
}

}  // namespace tessera::apps
