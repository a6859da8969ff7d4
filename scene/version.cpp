// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/version.hpp"

#include "scene/build_facts.hpp"
#include "scene/commit.hpp"

namespace tessera {
inline namespace v0_1 {

const char* version() { return TESSERA_VERSION; }
const char* commit() { return TESSERA_COMMIT; }
const char* build_facts() { return TESSERA_BUILD_FACTS; }

}  // namespace v0_1
}  // namespace tessera
