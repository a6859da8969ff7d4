// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::apps {

/// `tessera formats`: prints the formats that are read, with their extensions and limits, and those that are not, as
/// text or as JSON; from the table that the readers use (tessera/file_formats.hpp).
void formats(bool as_json);

}  // namespace tessera::apps
