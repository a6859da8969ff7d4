// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <string>

#include "scene/sample_source.hpp"

namespace tessera::scene {

/// The samples of another source, in which samples with values outside a closed range are blank. Whole voxels are
/// thereby left out: for point data, all voxels with such a corner. Since blank samples require a floating-point type,
/// samples are float32, or float64 if float32 cannot represent the source's type.
class ThresholdSource final : public SampleSource {
 public:
  /// `source` is the file's name in messages.
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
