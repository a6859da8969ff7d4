// SPDX-License-Identifier: BSD-3-Clause
// Copies samples from bricks into a SlabBlock, as lane scalars. Included once per instruction set (Highway's include
// guard idiom).
//
// What      A block has the slices of a chunk that a tile's rays meet, along the rays' axes; bricks are boxes along the
//           volume's axes ("native" below).
// How       Cells of 8^3 voxels that are invisible under the transfer function are not read: their samples are replaced
//           by the cell's smallest value, which is invisible too, or by blanks if the volume has blanks. Rows of
//           samples of the other cells are converted a vector at a time.
// Accuracy  LaneSamples::lane(), rounded to float; SlabBlock::rest keeps the rounding error where gradients need it.
// Bits      Whether a sample is read depends on cells alone, not on bricks, and conversion gives the bits of
//           LaneSamples::lane(). Therefore blocks are the same for any brick size.
// Ends      Blanks are NaN. Columns and rows beyond the box repeat its last ones.

#if defined(TESSERA_VOLUME_FILL_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_FILL_BLOCK_INL_H_
#undef TESSERA_VOLUME_FILL_BLOCK_INL_H_
#else
#define TESSERA_VOLUME_FILL_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <type_traits>

#include "volume/bricks/slab_block.hpp"
#include "volume/frame_view.hpp"
#include "volume/tile_rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {
/// Whether a visible cell contains one of the voxels low <= (i, j, k) <= high.
HWY_INLINE bool any_visible(const FrameView& frame, const std::int64_t (&low)[3], const std::int64_t (&high)[3]) {
  const scene::GridIndex& cells = frame.ranges->cells;
  constexpr std::int64_t side = CellRanges::side;
  for (std::int64_t c = low[2] / side; c <= high[2] / side; ++c)
    for (std::int64_t b = low[1] / side; b <= high[1] / side; ++b)
      for (std::int64_t a = low[0] / side; a <= high[0] / side; ++a)
        if (frame.visible[a + cells[0] * (b + cells[1] * c)] != 0) return true;
  return false;
}

namespace fill {

namespace hn = hwy::HWY_NAMESPACE;
using DD = hn::ScalableTag<double>;
using DFH = hn::Rebind<float, DD>;
using DIH = hn::Rebind<std::int32_t, DD>;

HWY_INLINE hn::Vec<DD> load_doubles(const float* p) { return PromoteTo(DD(), LoadU(DFH(), p)); }
HWY_INLINE hn::Vec<DD> load_doubles(const double* p) { return LoadU(DD(), p); }
HWY_INLINE hn::Vec<DD> load_doubles(const std::int32_t* p) { return PromoteTo(DD(), LoadU(DIH(), p)); }
template <class T>
HWY_INLINE hn::Vec<DD> load_doubles(const T* p) {
  if constexpr (sizeof(T) < 4) {
    return PromoteTo(DD(), PromoteTo(DIH(), LoadU(hn::Rebind<T, DD>(), p)));
  } else {
    HWY_ALIGN double values[MaxLanes(DD())];
    for (std::size_t i = 0; i < hn::Lanes(DD()); ++i) values[i] = p[i];
    return Load(DD(), values);
  }
}

/// Writes LaneSamples::lane() of `count` samples, bit for bit, and the rounding error of each unless `rest` is null.
/// `readable` samples may be read from `from` on. Up to a vector of floats, from `to` on, may be overwritten with
/// unchanged values.
template <class T>
HWY_INLINE void convert(const T* from, std::int64_t count, std::int64_t readable, const LaneSamples& lanes, float* to,
                        float* rest) {
  std::int64_t i = 0;
  if constexpr (std::is_same_v<T, float> || sizeof(T) <= 2) {
    // If the factor is a power of two and there is no shift, single precision rounds in the same way.
    if (lanes.scales_floats && rest == nullptr) {
      const hn::ScalableTag<float> df;
      const auto scale = Set(df, static_cast<float>(lanes.factor));
      const auto wide = static_cast<std::int64_t>(hn::Lanes(df));
      const auto vector_at = [&](std::int64_t at) HWY_ATTR {
        if constexpr (std::is_same_v<T, float>) {
          const auto sample = LoadU(df, from + at);
          const auto lane = sample * scale;
          return (lanes.whole ? Round(lane) : lane) + Sub(sample, sample);  // NaN if the sample is not finite
        } else {
          const hn::RebindToSigned<decltype(df)> di;
          const auto sample = ConvertTo(df, PromoteTo(di, LoadU(hn::Rebind<T, decltype(df)>(), from + at)));
          return Round(sample * scale);
        }
      };
      for (; i + wide <= count; i += wide) StoreU(vector_at(i), df, to + i);
      if (i == count) return;
      if (i + wide <= readable) {
        BlendedStore(vector_at(i), FirstN(df, static_cast<std::size_t>(count - i)), df, to + i);
        return;
      }
      if (count >= wide) {
        StoreU(vector_at(count - wide), df, to + count - wide);
        return;
      }
    }
  }
  const DD d;
  const auto factor = Set(d, lanes.factor), term = Set(d, lanes.term), lift = Set(d, lanes.lift);
  const auto n = static_cast<std::int64_t>(hn::Lanes(d));
  const auto some = [&](const T* p, float* out, float* rounded_off) HWY_ATTR {
    const auto sample = load_doubles(p);
    const auto exact = MulAdd(sample * lift, factor, term), lane = lanes.whole ? Round(exact) : exact;
    // inf - inf and NaN - NaN are NaN, x - x is 0: blanks become NaN.
    const auto rounded = DemoteTo(DFH(), lane + Sub(sample, sample));
    StoreU(rounded, DFH(), out);
    if (rounded_off != nullptr) StoreU(DemoteTo(DFH(), exact - PromoteTo(d, rounded)), DFH(), rounded_off);
  };
  for (; i + n <= count; i += n) some(from + i, to + i, rest == nullptr ? nullptr : rest + i);
  if (i >= count) return;
  T last[MaxLanes(DD())] = {};
  float out[MaxLanes(DD())], out_rest[MaxLanes(DD())];
  for (std::int64_t l = 0; l < n && i + l < count; ++l) last[l] = from[i + l];
  some(last, out, rest == nullptr ? nullptr : out_rest);
  for (std::int64_t l = 0; l < n && i + l < count; ++l) to[i + l] = out[l];
  for (std::int64_t l = 0; rest != nullptr && l < n && i + l < count; ++l) rest[i + l] = out_rest[l];
}

/// Calls f with a value of the samples' type.
template <class F>
HWY_INLINE void with_type(scene::SampleType type, const F& f) {
  switch (type) {
    case scene::SampleType::int8:
      return f(std::int8_t{});
    case scene::SampleType::uint8:
      return f(std::uint8_t{});
    case scene::SampleType::int16:
      return f(std::int16_t{});
    case scene::SampleType::uint16:
      return f(std::uint16_t{});
    case scene::SampleType::int32:
      return f(std::int32_t{});
    case scene::SampleType::uint32:
      return f(std::uint32_t{});
    case scene::SampleType::float32:
      return f(float{});
    case scene::SampleType::float64:
      return f(double{});
  }
}

/// Maps native boxes to positions in the block.
struct Target {
  const FrameView& frame;
  const RayAxes axes;
  SlabBlock& block;
  std::int64_t first_k;  ///< k of slice 0
  int slices;

  /// Returns the slice of a lattice plane along the k axis.
  HWY_INLINE int slice_of(std::int64_t native_k) const {
    const std::int64_t last = frame.samples[static_cast<std::size_t>(axes.k)] - 1;
    return static_cast<int>((axes.mirrored ? last - native_k : native_k) - first_k);
  }

  /// Calls put(x, y, z, count, to) for every row of samples of the native box [low, high] that is in the block, slice
  /// by slice. Must not be used if x is the rays' k axis.
  template <class Put>
  HWY_INLINE void rows_in(const std::int64_t (&low)[3], const std::int64_t (&high)[3], const Put& put) const {
    const auto ka = static_cast<std::size_t>(axes.k), ja = static_cast<std::size_t>(axes.j);
    for (std::int64_t k = low[ka]; k <= high[ka]; ++k) {
      const int n = slice_of(k);
      if (n < 0 || n >= slices) continue;
      const auto s = static_cast<std::size_t>(n);
      const std::int64_t x_0 = std::max<std::int64_t>(low[0], block.low_i[s]),
                         x_1 = std::min<std::int64_t>(high[0], block.low_i[s] + block.pitch - 1),
                         j_0 = std::max<std::int64_t>(low[ja], block.low_j[s]),
                         j_1 = std::min<std::int64_t>(high[ja], block.low_j[s] + block.rows - 1);
      if (x_0 > x_1) continue;
      float* to = block.slice(n) + (j_0 - block.low_j[s]) * block.pitch + (x_0 - block.low_i[s]);
      for (std::int64_t j = j_0; j <= j_1; ++j, to += block.pitch)
        put(x_0, axes.k == 1 ? k : j, axes.k == 1 ? j : k, x_1 - x_0 + 1, to);
    }
  }
  /// Whether rows_in() would find any row.
  HWY_INLINE bool any_in(const std::int64_t (&low)[3], const std::int64_t (&high)[3]) const {
    const auto ka = static_cast<std::size_t>(axes.k), ja = static_cast<std::size_t>(axes.j);
    for (std::int64_t k = low[ka]; k <= high[ka]; ++k) {
      const int n = slice_of(k);
      if (n < 0 || n >= slices) continue;
      const auto s = static_cast<std::size_t>(n);
      if (low[0] < block.low_i[s] + block.pitch && high[0] >= block.low_i[s] && low[ja] < block.low_j[s] + block.rows &&
          high[ja] >= block.low_j[s])
        return true;
    }
    return false;
  }

  /// Calls put(x_low, x_high, to) for the samples x_low..x_high of a native row that are in the block and contiguous
  /// there, beginning at `to`. If x is the k axis, samples are not contiguous, and `put` is called for each sample.
  template <class Put>
  HWY_INLINE void row(std::int64_t y, std::int64_t z, std::int64_t x_low, std::int64_t x_high, const Put& put) const {
    if (axes.k != 0) {
      const int n = slice_of(axes.k == 1 ? y : z);
      const auto s = static_cast<std::size_t>(n);
      const std::int64_t j = (axes.k == 1 ? z : y) - block.low_j[s];
      if (n < 0 || n >= slices || j < 0 || j >= block.rows) return;
      const std::int64_t low = std::max<std::int64_t>(x_low, block.low_i[s]),
                         high = std::min<std::int64_t>(x_high, block.low_i[s] + block.pitch - 1);
      if (low <= high) put(low, high, block.slice(n) + j * block.pitch + (low - block.low_i[s]));
    } else {
      for (std::int64_t x = x_low; x <= x_high; ++x) {
        const int n = slice_of(x);
        if (n < 0 || n >= slices) continue;
        const auto s = static_cast<std::size_t>(n);
        const std::int64_t i = y - block.low_i[s], j = z - block.low_j[s];
        if (i >= 0 && i < block.pitch && j >= 0 && j < block.rows) put(x, x, block.slice(n) + j * block.pitch + i);
      }
    }
  }
};

/// Fills one block: determines the samples that the block needs, and whether some of them are hidden.
class BlockFill {
 public:
  HWY_INLINE BlockFill(const FrameView& frame, const RayAxes& axes, const ChunkBox& box, SlabBlock& block)
      : frame_(frame),
        axes_(axes),
        box_(box),
        block_(block),
        shared_(frame.cell_data ? 0 : 1),
        slices_(box.slabs + static_cast<int>(shared_)),
        target_{frame, axes, block, box.first_k, slices_} {
    const auto ia = static_cast<std::size_t>(axes.i), ja = static_cast<std::size_t>(axes.j),
               ka = static_cast<std::size_t>(axes.k);
    low_[ia] = *std::min_element(block.low_i.begin(), block.low_i.begin() + slices_);
    low_[ja] = *std::min_element(block.low_j.begin(), block.low_j.begin() + slices_);
    high_[ia] = *std::max_element(block.low_i.begin(), block.low_i.begin() + slices_) + block.pitch - 1;
    high_[ja] = *std::max_element(block.low_j.begin(), block.low_j.begin() + slices_) + block.rows - 1;
    high_[ia] = std::min<std::int64_t>(high_[ia], box.i_last + shared_);
    high_[ja] = std::min<std::int64_t>(high_[ja], box.j_last + shared_);
    const std::int64_t first = box.first_k + box.first_slab, last = box.first_k + slices_ - 1;
    low_[ka] = axes.mirrored ? frame.samples[ka] - 1 - last : first;
    high_[ka] = axes.mirrored ? frame.samples[ka] - 1 - first : last;
    first_cell_ = std::max<std::int64_t>(0, cell_of(0, low_[0]) - shared_);
    last_cell_ = cell_of(0, high_[0]);
    some_hidden_ = any_hidden();
  }

  /// Replaces the samples of all cells by the cells' smallest values, if some cells are hidden.
  HWY_INLINE void fill_hidden() const {
    if (!some_hidden_) return;
    const scene::GridIndex& cells = frame_.ranges->cells;
    const auto ia = static_cast<std::size_t>(axes_.i), ja = static_cast<std::size_t>(axes_.j),
               ka = static_cast<std::size_t>(axes_.k);
    // Values between those of two hidden cells may be visible. If the volume has blanks, hidden samples become blank
    // instead.
    const bool has_blanks = frame_.ranges->range.blanks > 0;
    const std::int64_t stride[3] = {1, cells[0], cells[0] * cells[1]};
    for (int n = box_.first_slab; n < slices_; ++n) {
      const auto s = static_cast<std::size_t>(n);
      const std::int64_t k = axes_.mirrored ? frame_.samples[ka] - 1 - (box_.first_k + n) : box_.first_k + n;
      const std::int64_t columns = columns_of(n), rows = rows_of(n);
      for (std::int64_t j = 0; j < rows; ++j) {
        const float* const hidden =
            frame_.ranges->low.data() + stride[ka] * cell_of(ka, k) + stride[ja] * cell_of(ja, block_.low_j[s] + j);
        float* const to = block_.slice(n) + j * block_.pitch;
        for (std::int64_t i = 0; i < columns;) {
          const std::int64_t a = cell_of(ia, block_.low_i[s] + i),
                             end = a == cells[ia] - 1 ? columns : std::min(columns, (a + 1) * side - block_.low_i[s]);
          const float value = has_blanks ? std::numeric_limits<float>::quiet_NaN() : hidden[stride[ia] * a];
          std::fill(to + i, to + end, value);
          if (float* const rest = block_.rest_of(to + i)) std::fill_n(rest, end - i, 0.0f);
          i = end;
        }
      }
    }
  }

  /// Copies the visible samples from the bricks of the box.
  HWY_INLINE void take_bricks(std::vector<float>& row_memory) const {
    const BrickLayout& layout = frame_.bricks->layout();
    scene::GridIndex first, last;
    for (std::size_t a = 0; a < 3; ++a) {
      // A sample that two bricks share is taken from either; the lower one may be the only visible one.
      first[a] =
          std::max(layout.brick_of(a, std::max<std::int64_t>(0, low_[a] - shared_)), layout.brick_of(a, box_.low[a]));
      last[a] = std::min(layout.brick_of(a, high_[a]), layout.brick_of(a, box_.high[a] - 1));
    }
    for (std::int64_t bz = first[2]; bz <= last[2]; ++bz)
      for (std::int64_t by = first[1]; by <= last[1]; ++by)
        for (std::int64_t bx = first[0]; bx <= last[0]; ++bx) {
          const scene::GridIndex place{bx, by, bz};
          if (frame_.brick_visible[layout.number(place)] == 0) continue;
          if (!some_hidden_ && axes_.k != 0)
            take_all_of(place);
          else
            take_seen_of(place, row_memory);
        }
  }

  /// Fills columns and rows beyond the box with its last ones.
  HWY_INLINE void repeat_last() const {
    for (int n = box_.first_slab; n < slices_; ++n) {
      const std::int64_t columns = columns_of(n), rows = rows_of(n);
      for (float* const slice : {block_.slice(n), block_.rest_of(block_.slice(n))}) {
        if (slice == nullptr) continue;
        for (std::int64_t j = 0; j < rows && columns < block_.pitch; ++j)
          std::fill(slice + j * block_.pitch + columns, slice + (j + 1) * block_.pitch,
                    slice[j * block_.pitch + columns - 1]);
        for (std::int64_t j = rows; j < block_.rows; ++j)
          std::copy_n(slice + (rows - 1) * block_.pitch, block_.pitch, slice + j * block_.pitch);
      }
    }
  }

 private:
  static constexpr std::int64_t side = CellRanges::side;

  /// The number of columns and rows of a slice that are inside the box.
  [[nodiscard]] HWY_INLINE std::int64_t columns_of(int n) const {
    return std::min<std::int64_t>(block_.pitch, box_.i_last + 1 + shared_ - block_.low_i[static_cast<std::size_t>(n)]);
  }
  [[nodiscard]] HWY_INLINE std::int64_t rows_of(int n) const {
    return std::min<std::int64_t>(block_.rows, box_.j_last + 1 + shared_ - block_.low_j[static_cast<std::size_t>(n)]);
  }

  [[nodiscard]] HWY_INLINE std::int64_t cell_of(std::size_t axis, std::int64_t sample) const {
    return std::min(sample / side, frame_.ranges->cells[axis] - 1);
  }
  /// Whether cell `a` along x is visible in the row of samples (y, z). A row on a plane between cells belongs to both
  /// cells.
  [[nodiscard]] HWY_INLINE bool seen(std::int64_t a, std::int64_t y, std::int64_t z) const {
    const scene::GridIndex& cells = frame_.ranges->cells;
    const std::int64_t b = cell_of(1, y), c = cell_of(2, z);
    const std::int64_t b0 = shared_ != 0 && y % side == 0 && b > 0 ? b - 1 : b;
    const std::int64_t c0 = shared_ != 0 && z % side == 0 && c > 0 ? c - 1 : c;
    for (std::int64_t cc = c0; cc <= c; ++cc)
      for (std::int64_t bb = b0; bb <= b; ++bb)
        if (frame_.visible[a + cells[0] * (bb + cells[1] * cc)] != 0) return true;
    return false;
  }
  [[nodiscard]] HWY_INLINE bool any_hidden() const {
    const scene::GridIndex& cells = frame_.ranges->cells;
    for (std::int64_t c = std::max<std::int64_t>(0, low_[2] - shared_) / side; c <= cell_of(2, high_[2]); ++c)
      for (std::int64_t b = std::max<std::int64_t>(0, low_[1] - shared_) / side; b <= cell_of(1, high_[1]); ++b)
        for (std::int64_t a = first_cell_; a <= last_cell_; ++a)
          if (frame_.visible[a + cells[0] * (b + cells[1] * c)] == 0) return true;
    return false;
  }

  /// Returns the part of the block's samples that is in a brick.
  HWY_INLINE void part_in(const scene::SampleBox& brick, std::int64_t (&from)[3], std::int64_t (&to)[3]) const {
    for (std::size_t a = 0; a < 3; ++a) {
      from[a] = std::max(low_[a], brick.low[a]);
      to[a] = std::min(high_[a], brick.high[a] - 1);
    }
  }

  /// Copies all samples from a brick without hidden cells. Must not be used if x is the rays' k axis.
  HWY_INLINE void take_all_of(const scene::GridIndex& place) const {
    const BrickLayout& layout = frame_.bricks->layout();
    const scene::SampleBox brick = layout.box(place);
    const scene::GridIndex room = layout.room(place);
    std::int64_t from[3], to[3];
    part_in(brick, from, to);
    if (!target_.any_in(from, to)) return;
    const std::int64_t in_brick = room[0] * room[1] * room[2];
    const std::byte* const bytes = frame_.bricks->acquire(layout.number(place), frame_.trace);
    with_type(frame_.bricks->source().grid().type, [&](auto kind) HWY_ATTR {
      using T = decltype(kind);
      const auto* const samples = reinterpret_cast<const T*>(bytes);
      target_.rows_in(
          from, to, [&](std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t count, float* out) HWY_ATTR {
            const std::int64_t at = ((z - brick.low[2]) * room[1] + (y - brick.low[1])) * room[0] + (x - brick.low[0]);
            convert(samples + at, count, in_brick - at, frame_.lanes, out, block_.rest_of(out));
          });
    });
    frame_.bricks->release(layout.number(place));
  }

  /// Copies a brick's visible samples. The brick is not acquired if it has no visible samples.
  HWY_INLINE void take_seen_of(const scene::GridIndex& place, std::vector<float>& row_memory) const {
    const BrickLayout& layout = frame_.bricks->layout();
    const scene::SampleBox brick = layout.box(place);
    const scene::GridIndex room = layout.room(place);
    std::int64_t from[3], to[3];
    part_in(brick, from, to);
    const std::byte* bytes = nullptr;
    // Converts the brick's samples [first, first + count).
    const auto convert_some = [&](std::int64_t first, std::int64_t count, float* out, float* rest) HWY_ATTR {
      with_type(frame_.bricks->source().grid().type, [&](auto kind) HWY_ATTR {
        using T = decltype(kind);
        const std::int64_t readable = room[0] * room[1] * room[2] - first;
        convert(reinterpret_cast<const T*>(bytes) + first, count, readable, frame_.lanes, out, rest);
      });
    };
    for (std::int64_t z = from[2]; z <= to[2]; ++z)
      for (std::int64_t y = from[1]; y <= to[1]; ++y) {
        std::int64_t x = from[0];
        while (x <= to[0]) {
          // A run of samples that belong to visible cells; the samples of a cell are [8a, 8a + 8].
          std::int64_t end = to[0];
          if (some_hidden_ && !next_run(y, z, to[0], x, end)) continue;
          if (bytes == nullptr) bytes = frame_.bricks->acquire(layout.number(place), frame_.trace);
          const std::int64_t row_start = ((z - brick.low[2]) * room[1] + (y - brick.low[1])) * room[0] - brick.low[0];
          if (axes_.k != 0) {
            target_.row(y, z, x, end, [&](std::int64_t xa, std::int64_t xb, float* out) HWY_ATTR {
              convert_some(row_start + xa, xb - xa + 1, out, block_.rest_of(out));
            });
          } else {
            const auto count = static_cast<std::size_t>(end - x + 1);
            row_memory.resize(2 * count);
            convert_some(row_start + x, end - x + 1, row_memory.data(),
                         block_.has_rest ? row_memory.data() + count : nullptr);
            target_.row(y, z, x, end, [&](std::int64_t xa, std::int64_t, float* out) HWY_ATTR {
              *out = row_memory[static_cast<std::size_t>(xa - x)];
              if (block_.has_rest) *block_.rest_of(out) = row_memory[count + static_cast<std::size_t>(xa - x)];
            });
          }
          x = end + 1;
        }
      }
    if (bytes != nullptr) frame_.bricks->release(layout.number(place));
  }

  /// Returns whether the row's sample x is visible. If so, the samples [x, end] are visible. Otherwise x advances to
  /// the next candidate.
  HWY_INLINE bool next_run(std::int64_t y, std::int64_t z, std::int64_t last, std::int64_t& x,
                           std::int64_t& end) const {
    const std::int64_t a = cell_of(0, x), cells_x = frame_.ranges->cells[0];
    const bool own = seen(a, y, z);
    if (!own && !(shared_ != 0 && x % side == 0 && a > 0 && seen(a - 1, y, z))) {
      x = std::max(x + 1, a == cells_x - 1 ? last + 1 : a * side + side);
      return false;
    }
    end = !own ? x : std::min(last, a == cells_x - 1 ? last : a * side + side - 1 + shared_);
    return true;
  }

  const FrameView& frame_;
  const RayAxes axes_;
  const ChunkBox& box_;
  SlabBlock& block_;
  const std::int64_t shared_;
  const int slices_;
  const Target target_;
  std::int64_t low_[3], high_[3];        ///< samples that the block takes: the native box around all slices
  std::int64_t first_cell_, last_cell_;  ///< range of cells along x
  bool some_hidden_;
};

}  // namespace fill

/// Fills a block with the samples of a box of voxels. The block's slabs and slices must have been laid out. Reads only
/// bricks that have voxels of the box.
HWY_NOINLINE inline void fill_block(const FrameView& frame, const RayAxes& axes, const ChunkBox& box,
                                    std::vector<float>& row_memory, SlabBlock& block) {
  const fill::BlockFill filling(frame, axes, box, block);
  filling.fill_hidden();
  filling.take_bricks(row_memory);
  filling.repeat_last();
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
