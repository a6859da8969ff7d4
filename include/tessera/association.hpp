#pragma once

namespace tessera::inline v0_1 {

/// Which mesh element carries the scalar.
enum class Association { point, cell };

}  // namespace tessera::inline v0_1
