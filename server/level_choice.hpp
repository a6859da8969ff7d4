// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "tessera/camera.hpp"

namespace tessera::server {

/// Which part of a picture's sides pictures have while something moves.
inline constexpr std::array shrinks = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};

/// At least one pixel a side.
ImageSize shrunk(ImageSize size, double shrink);

/// Chooses by measured times how large a client's pictures are while it moves: the largest that keep to a budget. Of a
/// smaller picture a part of the time, that of the data, stays; so where even the smallest takes too long, a stand-in
/// of the data is asked for.
class LevelChoice {
 public:
  explicit LevelChoice(double budget_ms) : budget_ms_(budget_ms) {}

  [[nodiscard]] std::size_t shrink() const { return at_; }
  [[nodiscard]] bool wants_stand_in() const { return stand_in_; }
  [[nodiscard]] double budget_ms() const { return budget_ms_; }

  /// A frame of a size took so long, from the event to the client's word that it is painted. `stand_in`: of one.
  void took(std::size_t shrink, bool stand_in, double ms);
  /// A picture in full size took so long to render: what is known before anything moves, or of data that changed.
  void full_took(double ms);

 private:
  /// The smallest step down whose time should be within the budget; past the last none is.
  [[nodiscard]] std::size_t fitting(std::size_t from, double ms) const;

  double budget_ms_;
  std::size_t at_ = 2;
  bool stand_in_ = false, measured_ = false;
};

}  // namespace tessera::server
