// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <string>

#include "scene/sample_source.hpp"

namespace tessera::scene {

/// The samples of another source; those with values outside a closed range are blank. This leaves out whole voxels, for
/// point data all with such a corner. Since blanks need a float type, samples are float32, or float64 if floats cannot
/// represent the source's type.
class ThresholdSource final : public SampleSource {
 public:
  /// `source`: the file's name in messages.
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
