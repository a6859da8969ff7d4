// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <string>

#include "scene/sample_source.hpp"

namespace tessera::scene {

/// Another source's samples, those blank whose values are outside of a range, ends included: so whole voxels are left
/// out, of point data all that have such a corner. As blanks need a float type, samples are float32, or float64 where
/// floats do not hold theirs.
class ThresholdSource final : public SampleSource {
 public:
  /// `source`: the file's name for messages.
  ThresholdSource(std::unique_ptr<SampleSource> all, const std::array<double, 2>& range, std::string source);

  [[nodiscard]] GridIndex storage_block() const override { return all_->storage_block(); }
  [[nodiscard]] std::uint64_t bytes_read() const override { return all_->bytes_read(); }

 private:
  void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const override;
  template <class T>
  void read_as(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const;

  std::unique_ptr<SampleSource> all_;
  std::array<double, 2> range_;
};

}  // namespace tessera::scene
