// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::apps {

/// Implements `tessera formats`: prints the formats that can be read, with their extensions and limits, and the formats
/// that cannot, as text or as JSON. The formats are those of the table that the readers use (tessera/file_formats.hpp).
void formats(bool as_json);

}  // namespace tessera::apps
