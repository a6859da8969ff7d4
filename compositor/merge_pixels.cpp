// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <utility>

#include "compositor/merge_kinds.hpp"
#include "scene/error.hpp"

namespace tessera::compositor {
namespace {

/// A tile that arrives finished: its pixels are passed on unchanged.
class PixelMerger final : public TileMerger {
 public:
  void add(const exchange::TilePart& part) override {
    if (part.kind != exchange::RecordKind::pixels || !pixels_.empty())
      throw scene::Error(
          scene::ErrorCode::system_failure,
          fmt::format("exchange: tile {} was received again after it was complete; all ranks must run the same program",
                      part.tile));
    const auto bytes = part.records.bytes();
    pixels_.assign(bytes.begin(), bytes.end());
  }
  void advance(double /*final_depth*/) override {}
  MergedTile finish() override { return {{}, {}, {}, std::move(pixels_)}; }

 private:
  exchange::Bytes pixels_;
};

}  // namespace

std::unique_ptr<TileMerger> make_pixel_merger() { return std::make_unique<PixelMerger>(); }

}  // namespace tessera::compositor
