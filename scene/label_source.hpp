// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/sample_source.hpp"

/// Grids whose values are labels: numbers of organs, regions, materials. A mean of two labels means nothing, so each
/// sample fills the voxel round it.
namespace tessera::scene {

/// Whether a grid's values are labels, and which there are.
struct LabelValues {
  bool are_labels = false;
  std::vector<double> values;  ///< all of them, ascending; empty if not labels, or more than 4096
};

/// Reads all samples if they may be labels, else some slices.
///
/// stated  The header states it: they are labels whatever they are.
/// else    Whole numbers, more than two of them, that neighbours along i share: of 24 or fewer, three in ten of the
/// pairs
///         of neighbours that are not both background (the commonest value); of those from 0 to 63, half of them; of
///         more, half of each label's in the median, with steps of two or more in the mean of a slice.
/// Blank samples do not count.
LabelValues label_values(const SampleSource& source, bool stated);

/// The samples of a point grid as a cell grid: sample (i, j, k) fills a voxel that reaches half way to its neighbours,
/// and as far beyond the first and the last.
class LabelSource final : public SampleSource {
 public:
  /// `source`: the file's name for messages.
  LabelSource(std::shared_ptr<const SampleSource> points, std::string source);

  /// As they are in the file.
  [[nodiscard]] const SampleSource& points() const { return *points_; }
  [[nodiscard]] std::optional<ValueRange> known_range(const SampleBox& box) const override {
    return points_->known_range(box);
  }
  [[nodiscard]] GridIndex storage_block() const override { return points_->storage_block(); }
  [[nodiscard]] std::uint64_t bytes_read() const override { return points_->bytes_read(); }

 private:
  void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const override;

  std::shared_ptr<const SampleSource> points_;
};

}  // namespace tessera::scene
