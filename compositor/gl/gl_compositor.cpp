// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/gl/gl_compositor.hpp"

#include <fmt/format.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "compositor/gl/gl_kernel.hpp"
#include "scene/error.hpp"
#include "scene/start_thread.hpp"

namespace tessera::compositor {

class GlCompositor::Worker {
 public:
  Worker(gl::Platform platform, const GlSettings& settings, scene::Trace* trace)
      : settings_(settings), trace_(trace), thread_(scene::start_thread([this, platform] { live(platform); })) {}
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  std::string opened() { return opened_.get_future().get(); }

  std::future<std::vector<GlLight>> take(GlJob job) { return put(std::move(job), jobs_); }
  std::future<std::vector<std::uint32_t>> take(GlCount job) { return put(std::move(job), counts_); }

 private:
  using Batch = std::vector<GlJob>;

  template <class Job>
  auto put(Job job, std::deque<Job>& queue) -> decltype(job.done.get_future()) {
    auto future = job.done.get_future();
    {
      const std::lock_guard lock(mutex_);
      if (failure_)
        job.done.set_exception(failure_);
      else
        queue.push_back(std::move(job));
    }
    changed_.notify_all();
    return future;
  }

  /// The thread's function; the context exists only here.
  void live(gl::Platform platform) {
    std::unique_ptr<gl::Context> context;
    std::unique_ptr<GlKernel> kernel;
    try {
      context = gl::open_context(platform, settings_.egl_device);
      kernel = settings_.method == GlMethod::compute ? make_compute_kernel(*context, settings_, trace_)
                                                     : make_fragment_kernel(*context, settings_, trace_);
      opened_.set_value(context->name());
    } catch (...) {
      opened_.set_exception(std::current_exception());
      return;
    }
    std::deque<Batch> under_way;
    try {
      work(*context, *kernel, under_way);
    } catch (...) {
      fail(std::current_exception(), under_way);
    }
  }

  void work(gl::Context& context, GlKernel& kernel, std::deque<Batch>& under_way) {
    auto begin_batch = [&, batches = 0]() mutable {
      if (settings_.fault != GlFault::none && batches++ >= settings_.fault_after)
        context.pretend(settings_.fault == GlFault::lost ? GL_CONTEXT_LOST : GL_OUT_OF_MEMORY);
    };
    for (;;) {
      Batch batch = next(under_way.empty());
      if (counting_) {
        begin_batch();
        counting_->done.set_value(kernel.count(*counting_));
        counting_.reset();
        continue;
      }
      if (batch.empty() && under_way.empty()) return;
      if (!batch.empty()) {
        begin_batch();
        under_way.push_back(std::move(batch));
        kernel.begin(under_way.back());
        context.check("compositing");
        if (under_way.size() < static_cast<std::size_t>(kernel.in_flight())) continue;
      }
      auto lights = kernel.finish();
      Batch done = std::move(under_way.front());
      under_way.pop_front();
      for (std::size_t i = 0; i < done.size(); ++i) done[i].done.set_value(std::move(lights[i]));
    }
  }

  /// Returns jobs of one frame, as many as fit in one batch. If `wait` is set, waits for jobs. Returns no jobs if the
  /// compositor is ending, if no jobs are queued, or if cells are to be counted (`counting_`). Counting has priority
  /// because the jobs of the cells' tile need its result.
  Batch next(bool wait) {
    std::unique_lock lock(mutex_);
    if (wait) changed_.wait(lock, [&] { return ending_ || !jobs_.empty() || !counts_.empty(); });
    Batch batch;
    if (!ending_ && !counts_.empty()) {
      counting_.emplace(std::move(counts_.front()));
      counts_.pop_front();
      return batch;
    }
    std::size_t fragments = 0;
    while (!ending_ && !jobs_.empty()) {
      const GlJob& job = jobs_.front();
      fragments += job.fragments.size();
      if (!batch.empty() && (job.rules.frame != batch.front().rules.frame || fragments > settings_.batch_fragments))
        break;
      batch.push_back(std::move(jobs_.front()));
      jobs_.pop_front();
    }
    return batch;
  }

  void fail(const std::exception_ptr& failure, std::deque<Batch>& under_way) {
    const std::lock_guard lock(mutex_);
    failure_ = failure;
    for (Batch& batch : under_way)
      for (GlJob& job : batch) job.done.set_exception(failure);
    for (GlJob& job : jobs_) job.done.set_exception(failure);
    jobs_.clear();
    if (counting_) counting_->done.set_exception(failure);
    for (GlCount& job : counts_) job.done.set_exception(failure);
    counts_.clear();
  }

  GlSettings settings_;
  scene::Trace* trace_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::deque<GlJob> jobs_;
  std::deque<GlCount> counts_;
  std::exception_ptr failure_;
  bool ending_ = false;
  std::optional<GlCount> counting_;  // used only by the thread
  std::promise<std::string> opened_;
  std::thread thread_;  // last, because it uses all of the above
};

GlCompositor::GlCompositor(gl::Platform platform, const GlSettings& settings, scene::Trace* trace)
    : method_(settings.method),
      comfortable_fragments_(settings.batch_fragments),
      worker_(std::make_unique<Worker>(platform, settings, trace)) {
  name_ =
      fmt::format("{} ({})", settings.method == GlMethod::compute ? "gl-compute" : "gl-fragment", worker_->opened());
}

GlCompositor::~GlCompositor() = default;

std::future<std::vector<GlLight>> GlCompositor::composite(GlFragments fragments, const GlRules& rules) {
  return worker_->take(GlJob{std::move(fragments), rules, {}});
}

std::future<std::vector<std::uint32_t>> GlCompositor::count(std::shared_ptr<const GlCells> cells,
                                                            const scene::PixelRect& rect, std::uint32_t frame) {
  return worker_->take(GlCount{std::move(cells), rect, frame, {}});
}

}  // namespace tessera::compositor
