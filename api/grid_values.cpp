// SPDX-License-Identifier: BSD-3-Clause
#include "api/grid_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "frame/grid/scan_together.hpp"
#include "frame/grid/shared_labels.hpp"
#include "scene/fill_value.hpp"
#include "scene/label_source.hpp"
#include "scene/threshold_source.hpp"

namespace tessera::api {
namespace {

/// Whether the volume is a medical scan, according to its modality or because its values are a patient's Hounsfield
/// units. Scans are not labels even if they have few values, as those of a phantom or a test image do.
bool is_scan(const io::VolumeFile& volume, const std::vector<double>& values) {
  const bool patient = volume.body_axes != BodyAxes::none || volume.axes_if_ct != BodyAxes::none;
  return !volume.tags.modality.empty() || (patient && values.front() <= -900 && values.back() >= 200);
}

}  // namespace

void leave_fill_values_out(io::VolumeFile& volume, const std::filesystem::path& file,
                           const std::optional<std::array<double, 2>>& threshold, exchange::Transport& transport,
                           std::shared_ptr<const volume::CellRanges>& ranges) {
  std::optional<scene::FillValue> fill = scene::find_fill_value(*volume.source, ranges->range);
  if (!fill) return;
  if (fill->is_huge()) {
    volume.notes.push_back(fmt::format("{} samples have the value {:.7g}, a fill value: they are blank", fill->count,
                                       fmt::join(fill->values, " or ")));
  } else if (!fill->is_outside(threshold)) {
    volume.notes.push_back(scene::words_on(*fill, "samples"));
    return;
  }
  volume.source = std::make_unique<scene::ThresholdSource>(
      std::move(volume.source), std::array{fill->others.low, fill->others.high}, file.string());
  ranges = std::make_shared<const volume::CellRanges>(frame::scan_together(transport, *volume.source));
  fill = scene::find_fill_value(*volume.source, ranges->range);
  if (fill && !fill->is_huge() && !fill->is_outside(threshold))
    volume.notes.push_back(scene::words_on(*fill, "samples"));
}

void note_byte_order(io::VolumeFile& volume, bool big_endian, const scene::ValueRange& range) {
  const double most = std::max(std::abs(range.low), std::abs(range.high));
  if (volume.format != "raw samples" || !is_float(volume.source->grid().type) || range.empty() || most == 0 ||
      (most > 1e-30 && most < 1e30))
    return;
  volume.notes.push_back(fmt::format("its values look as if they were in the other byte order: try `endian` {}",
                                     big_endian ? "little" : "big"));
}

std::vector<double> take_labels(const std::filesystem::path& file, std::optional<bool> asked,
                                exchange::Transport& transport, io::VolumeFile& volume) {
  if (asked == false) return {};
  const bool stated = asked.value_or(false) || volume.tags.labels;
  scene::LabelValues found = frame::shared_labels(transport, *volume.source, stated);
  if (!found.are_labels || (!stated && is_scan(volume, found.values))) return {};
  if (volume.source->geometry().association == Association::point) {
    volume.source = std::make_unique<scene::LabelSource>(std::move(volume.source), file.string());
    volume.notes.push_back(
        fmt::format("values are labels{}: each sample fills its voxel, without interpolation between samples (`labels` "
                    "off interpolates)",
                    found.values.empty() ? "" : fmt::format(", {} of them", found.values.size())));
  }
  return std::move(found.values);
}

}  // namespace tessera::api
