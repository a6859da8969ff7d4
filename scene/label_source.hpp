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
  std::vector<double> values;  ///< all of them, ascending; empty if not labels, or more than 4096
};

/// Reads all samples if they may be labels, otherwise some slices.
///
/// stated     The header states it: they are labels in any case.
/// otherwise  More than two different whole numbers, with equal neighbours along i. Up to 24 values: three in ten of
///            the neighbour pairs that are not both background (the most common value). Values from 0 to 63: half of
///            these pairs. More values: half of the pairs of the median label, and differences of two or more on
///            average in a slice.
///
/// Blank samples do not count.
LabelValues label_values(const SampleSource& source, bool stated);

/// The samples of a point grid as a cell grid: sample (i, j, k) fills a voxel that extends midway to its neighbours,
/// and by half a spacing beyond the first and the last.
class LabelSource final : public SampleSource {
 public:
  /// `source`: the file's name in messages.
  LabelSource(std::shared_ptr<const SampleSource> points, std::string source);

  /// The samples as in the file.
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
