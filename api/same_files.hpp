// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"

namespace tessera::api {

/// Checks that all ranks have read the same files, which may differ if nodes of a cluster have their own copies.
/// Compares all files read since the last call. A file that only some ranks have read is compared with the file of the
/// same name on the first rank. Files up to 1 MiB are compared by length and content, larger ones by length and 16 KiB
/// at 64 places; modification times are ignored, because those of copies may differ. Throws Error(bad_input), which
/// names the file, on a rank that finds a difference. Collective.
void require_same_files(exchange::Transport& transport);

}  // namespace tessera::api
