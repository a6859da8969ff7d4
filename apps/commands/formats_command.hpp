// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::apps {

/// `tessera formats`: what is read, by which names and within which limits, and what is not, on stdout, as text or as
/// JSON; from the table that readers go by (tessera/file_formats.hpp).
void formats(bool as_json);

}  // namespace tessera::apps
