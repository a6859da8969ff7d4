// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera {
inline namespace v0_1 {

/// Which mesh element carries the scalar.
enum class Association { point, cell };

}  // namespace v0_1
}  // namespace tessera
