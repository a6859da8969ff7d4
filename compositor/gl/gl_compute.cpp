// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <optional>

#include "compositor/gl/gl_cell_lists.hpp"
#include "compositor/gl/gl_kernel.hpp"
#include "compositor/shader_files.hpp"
#include "gl/buffer.hpp"
#include "gl/shader.hpp"
#include "gl/timer.hpp"
#include "sorting/gl/gl_list_sort.hpp"

namespace tessera::compositor {
namespace {

using gl::Buffer;

constexpr std::size_t group_of_fragments = 256, group_of_lists = 64;  // the shaders' local sizes

GLuint groups(std::size_t count, std::size_t size) { return static_cast<GLuint>((count + size - 1) / size); }

/// Compute shaders on storage buffers: they integrate every segment, sort the lists, and composite each list front to
/// back. In jobs with cells, the cells' segments are first rasterized into the lists, between the given fragments.
///
/// Two batches are in flight. There are two mapped memories for uploads and results, but only one working memory for
/// the shaders, because the device executes its commands in order.
class ComputeKernel final : public GlKernel {
 public:
  ComputeKernel(const gl::Context& context, const GlSettings& settings, scene::Trace* trace)
      : context_(&context),
        settings_(settings),
        trace_(trace),
        integrate_(context, {{GL_COMPUTE_SHADER, {shader_files::integrals_glsl, shader_files::integrate_comp}}}),
        composite_(context, {{GL_COMPUTE_SHADER, {shader_files::composite_comp}}}),
        sort_(context),
        integrals_(context),
        keys_(context, Buffer::Use::device),
        sorted_0_(context, Buffer::Use::device),
        sorted_1_(context, Buffer::Use::device),
        values_(context, Buffer::Use::device),
        tables_(context, Buffer::Use::device),
        lights_(context, Buffer::Use::device),
        slots_{Slot(context, trace), Slot(context, trace)} {}

  [[nodiscard]] int in_flight() const override { return 2; }

  void begin(std::span<GlJob> jobs) override {
    Slot& slot = slots_[next_];
    under_way_.push_back(next_);
    next_ = 1 - next_;
    const GlRules& rules = jobs.front().rules;
    const auto [fragments, given] = upload(jobs, slot);
    const gl::Functions& gl = context_->gl();

    gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    const std::size_t key_bytes = given * sizeof(sorting::GlKey), value_bytes = 16 * given;
    if (slot.pixels == 0) {
      keys_.copy_from(slot.upload, 0, key_bytes);
      values_.copy_from(slot.upload, key_bytes, value_bytes);
    }
    tables_.copy_from(slot.upload, key_bytes + value_bytes, slot.table_bytes);

    slot.timer.begin(static_cast<std::int32_t>(rules.frame));
    if (slot.pixels > 0) {
      cell_lists().fill({jobs, &slot.upload, given, fragments, key_bytes + value_bytes + slot.table_bytes, slot.pixels},
                        keys_, values_);
      slot.timer.record("project");
    }
    integrate_.use();
    integrals_.prepare(integrate_, rules);
    integrate_.set(0, static_cast<GLuint>(fragments));
    values_.bind(0);
    gl.DispatchCompute(groups(fragments, group_of_fragments), 1, 1);
    slot.timer.record("integrate");

    const std::uint32_t passes = sort_.sort(keys_, {&sorted_0_, &sorted_1_}, tables_);
    slot.timer.record("sort", passes);

    composite_.use();
    composite_.set(0, slot.first_list);
    composite_.set(1, static_cast<GLuint>(slot.lists));
    composite_.set(2, rules.least_transmittance);
    values_.bind(0);
    sorted_0_.bind(1);
    sorted_1_.bind(2);
    tables_.bind(4);
    lights_.bind(5);
    gl.DispatchCompute(groups(slot.lists, group_of_lists), 1, 1);
    if (slot.pixels > 0)
      cell_lists().complete({tables_, slot.first_list, static_cast<GLuint>(slot.lists)}, keys_, lights_, integrals_,
                            rules);
    gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    slot.timer.record("composite");
    slot.readback.copy_from(lights_, 0, slot.lists * sizeof(GlLight));
    slot.fence.set();
  }

  std::vector<std::vector<GlLight>> finish() override {
    Slot& slot = slots_[under_way_.front()];
    under_way_.pop_front();
    slot.fence.wait();
    slot.timer.collect();
    std::vector<std::vector<GlLight>> lights;
    const std::byte* from = slot.readback.mapped();
    for (const Counts& job : slot.jobs) {
      auto& of_job = lights.emplace_back(job.lists);
      if (job.lists > 0) std::memcpy(of_job.data(), from, job.lists * sizeof(GlLight));
      from += job.lists * sizeof(GlLight);
      for (GlLight& light : of_job)
        if (light.first < GlLight::rasterized_one) light.first -= job.first_fragment;
    }
    return lights;
  }

  std::vector<std::uint32_t> count(const GlCount& job) override { return cell_lists().count(job); }

 private:
  struct Counts {
    std::size_t lists;
    std::uint32_t first_fragment;
  };
  /// The memory of one batch.
  struct Slot {
    Slot(const gl::Context& context, scene::Trace* trace)
        : upload(context, Buffer::Use::upload),
          readback(context, Buffer::Use::readback),
          fence(context),
          timer(context, trace) {}
    Buffer upload, readback;
    gl::Fence fence;
    gl::StageTimer timer;
    std::vector<Counts> jobs;
    std::size_t lists = 0, table_bytes = 0;
    std::size_t pixels = 0;  ///< number of pixels in jobs with cells
    GLuint first_list = 0;   ///< first list in the tables, counted in entries of four integers
  };

  /// Returns the lists of cells, whose shaders are compiled when the first cells arrive.
  GlCellLists& cell_lists() {
    if (!cell_lists_) cell_lists_.emplace(*context_, settings_.batch_cells, trace_);
    return *cell_lists_;
  }

  struct Fragments {
    std::size_t all, given;
  };
  /// Writes the keys, values and tables of all jobs one after the other, and the positions of the fragments that the
  /// device makes.
  Fragments upload(std::span<GlJob> jobs, Slot& slot) {
    std::size_t fragments = 0, given = 0;
    lists_.clear();
    list_given_.clear();
    first_.clear();
    slot.jobs.clear();
    for (const GlJob& job : jobs) {
      slot.jobs.push_back({job.fragments.lists.size(), static_cast<std::uint32_t>(fragments)});
      first_.push_back(static_cast<std::uint32_t>(fragments));
      for (const GlFragments::List& list : job.fragments.lists) {
        lists_.push_back({static_cast<std::uint32_t>(fragments) + list.begin, list.count});
        list_given_.push_back(list.count - list.rasterized);
      }
      fragments += job.fragments.size();
      given += job.fragments.keys.size();
    }
    const std::vector<std::uint32_t> next = GlCellLists::next_elements(jobs, first_);
    slot.pixels = next.size();
    sort_.plan(lists_);
    const auto passes = sort_.tables();
    slot.lists = lists_.size();
    slot.first_list = static_cast<GLuint>((passes.size() + 3) / 4);
    slot.table_bytes = 16 * (slot.first_list + lists_.size());

    const std::size_t key_bytes = given * sizeof(sorting::GlKey), value_bytes = 16 * given;
    const std::size_t all_key_bytes = fragments * sizeof(sorting::GlKey);
    slot.upload.reserve(key_bytes + value_bytes + slot.table_bytes + next.size() * sizeof(std::uint32_t));
    keys_.reserve(all_key_bytes);
    sorted_0_.reserve(all_key_bytes);
    if (std::any_of(lists_.begin(), lists_.end(),
                    [](const sorting::GlList& list) { return list.count > sorting::GlListSort::piece_size; }))
      sorted_1_.reserve(all_key_bytes);
    else
      sorted_1_.reserve(16);
    values_.reserve(16 * fragments);
    tables_.reserve(slot.table_bytes);
    lights_.reserve(slot.lists * sizeof(GlLight));
    slot.readback.reserve(slot.lists * sizeof(GlLight));

    std::byte* keys = slot.upload.mapped();
    std::byte* values = keys + key_bytes;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      GlFragments& of_job = jobs[i].fragments;
      for (sorting::GlKey& key : of_job.keys) key.element += slot.jobs[i].first_fragment;
      const std::size_t count = of_job.keys.size();
      if (count == 0) continue;
      std::memcpy(keys, of_job.keys.data(), count * sizeof(sorting::GlKey));
      std::memcpy(values, of_job.values.data(), 16 * count);
      keys += count * sizeof(sorting::GlKey);
      values += 16 * count;
    }
    std::byte* tables = slot.upload.mapped() + key_bytes + value_bytes;
    if (!passes.empty()) std::memcpy(tables, passes.data(), passes.size_bytes());
    tables += 16 * std::size_t{slot.first_list};
    for (std::size_t i = 0; i < lists_.size(); ++i) {
      const sorting::GlList& list = lists_[i];
      const std::uint32_t entry[4] = {list.begin, list.count, sorting::GlListSort::buffer_of(list.count),
                                      list_given_[i]};
      std::memcpy(tables, entry, sizeof entry);
      tables += sizeof entry;
    }
    if (!next.empty()) std::memcpy(tables, next.data(), next.size() * sizeof(std::uint32_t));
    return {fragments, given};
  }

  const gl::Context* context_;
  GlSettings settings_;
  scene::Trace* trace_;
  gl::Program integrate_, composite_;
  sorting::GlListSort sort_;
  GlIntegrals integrals_;
  Buffer keys_, sorted_0_, sorted_1_, values_, tables_, lights_;
  std::array<Slot, 2> slots_;
  std::size_t next_ = 0;
  std::deque<std::size_t> under_way_;
  std::vector<sorting::GlList> lists_;
  std::vector<std::uint32_t> list_given_;  ///< for each list, the number of fragments that came with the job
  std::vector<std::uint32_t> first_;       ///< for each job, the first fragment of its lists
  std::optional<GlCellLists> cell_lists_;
};

}  // namespace

void GlIntegrals::prepare(const gl::Program& program, const GlRules& rules) {
  const integrals::LaneTable& table = *rules.table;
  if (frame_ != static_cast<std::int64_t>(rules.frame)) {
    fence_.wait();  // waits until the previous table has been copied from `upload_`
    const std::size_t bytes = table.rows.size() * sizeof(float);
    upload_.reserve(bytes);
    table_.reserve(bytes);
    std::memcpy(upload_.mapped(), table.rows.data(), bytes);
    table_.copy_from(upload_, 0, bytes);
    fence_.set();
    frame_ = rules.frame;
  }
  table_.bind(3);
  program.set(10, static_cast<GLuint>(table.stride));
  program.set(11, static_cast<GLuint>(table.knot_count));
  program.set(12, static_cast<GLuint>(table.emission == scene::Emission::independent));
  program.set(13, static_cast<GLuint>(rules.samples));
}

std::unique_ptr<GlKernel> make_compute_kernel(const gl::Context& context, const GlSettings& settings,
                                              scene::Trace* trace) {
  return std::make_unique<ComputeKernel>(context, settings, trace);
}

}  // namespace tessera::compositor
