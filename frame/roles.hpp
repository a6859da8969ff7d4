#pragma once

#include <optional>
#include <vector>

namespace tessera::frame {

/// Which ranks project and which composite. The first compositor assembles the pictures.
struct Roles {
  std::vector<int> projectors, compositors;
  [[nodiscard]] bool projects(int rank) const;
  [[nodiscard]] bool composites(int rank) const;
  [[nodiscard]] int assembler() const { return compositors.front(); }
};

/// N projectors and P compositors on `ranks` ranks. N + P ranks: ranks 0 .. N-1 project, the others composite. max(N,
/// P) ranks: both start at rank 0 and share. With one number given the other takes what is left, or shares if nothing
/// is; with none every rank does both. Throws Error(bad_input) for numbers that fit neither way.
Roles assign_roles(int ranks, std::optional<int> projectors, std::optional<int> compositors);

}  // namespace tessera::frame
