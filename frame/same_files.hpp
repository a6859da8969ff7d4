#pragma once

#include "exchange/transport.hpp"

namespace tessera::frame {

/// Throws Error(bad_input) on a rank that has read another file than a rank before it under the same name, as where the
/// nodes of a cluster have copies of which one is older: of all files read since the last call, and of those that other
/// ranks read alone as the first rank sees them. Compared are the length and the bytes, of files above 1 MiB those of
/// 64 places. Not the time: copies of one file may be of several. Collective.
void require_same_files(exchange::Transport& transport);

}  // namespace tessera::frame
