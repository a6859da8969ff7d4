#include "tessera/version.hpp"

#include "scene/build_facts.hpp"
#include "scene/commit.hpp"

namespace tessera::inline v0_1 {

const char* version() { return TESSERA_VERSION; }
const char* commit() { return TESSERA_COMMIT; }
const char* build_facts() { return TESSERA_BUILD_FACTS; }

}  // namespace tessera::inline v0_1
