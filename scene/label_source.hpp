// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/sample_source.hpp"

/// Grids whose values are labels: numbers of organs, regions, materials. The mean of two labels has no meaning, so each
/// sample fills the voxel around it.
namespace tessera::scene {

/// Whether a grid's values are labels, and which labels occur.
struct LabelValues {
  bool are_labels = false;
  std::vector<double> values;  ///< all labels, ascending; empty if the values are not labels, or if there are more than
                               ///< 4096
};

/// Reads all samples if they may be labels, otherwise some slices.
///
/// stated     The header states that the values are labels.
/// otherwise  The values are labels if they are more than two different whole numbers and enough neighbours along i are
///            equal. Pairs of neighbours that are both background (the most common value) are not counted. With up to
///            24 different values, three in ten of the pairs must be equal. With values from 0 to 63, half of the pairs
///            must be equal. With more values, half of the pairs of the median label must be equal, and values must
///            differ by two or more on average in a slice.
///
/// Blank samples are not counted.
LabelValues label_values(const SampleSource& source, bool stated);

/// The samples of a point grid as a cell grid. Sample (i, j, k) fills a voxel that extends midway to its neighbours or,
/// at the first and the last sample, by half a spacing.
class LabelSource final : public SampleSource {
 public:
  /// `source` is the file's name in messages.
  LabelSource(std::shared_ptr<const SampleSource> points, std::string source);

  /// The samples as point data, as in the file.
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
