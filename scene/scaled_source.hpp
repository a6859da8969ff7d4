// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <string>

#include "scene/sample_source.hpp"

namespace tessera::scene {

/// Returns the grid with the axes of the world multiplied by `scale`, whose factors are above 0.
GridGeometry scaled(GridGeometry geometry, const glm::dvec3& scale);

/// The samples of another source, on the same grid with the axes of the world scaled.
class ScaledSource final : public SampleSource {
 public:
  /// `source` is the file's name in messages.
  ScaledSource(std::unique_ptr<SampleSource> all, const glm::dvec3& scale, std::string source);

  [[nodiscard]] std::optional<ValueRange> known_range(const SampleBox& box) const override {
    return all_->known_range(box);
  }
  [[nodiscard]] GridIndex storage_block() const override { return all_->storage_block(); }
  [[nodiscard]] std::uint64_t bytes_read() const override { return all_->bytes_read(); }

 private:
  void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const override;

  std::unique_ptr<SampleSource> all_;
};

}  // namespace tessera::scene
