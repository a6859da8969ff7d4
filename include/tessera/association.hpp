#pragma once

namespace tessera {

/// Which mesh element carries the scalar.
enum class Association { point, cell };

}  // namespace tessera
