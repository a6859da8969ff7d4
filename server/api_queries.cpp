#include "server/api.hpp"
#include "tessera/error.hpp"

namespace tessera::server {

Json histogram_answer(const ApiContext& /*context*/, const OpenScene& /*open*/, const Json& /*body*/) {
  throw bad_input("histogram: it is not there yet; ask for the function");
}

Json probe_answer(const ApiContext& /*context*/, const OpenScene& /*open*/, const Json& /*body*/) {
  throw bad_input("probe: it is not there yet; ask for the picture");
}

}  // namespace tessera::server
