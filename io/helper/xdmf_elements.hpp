#pragma once

#include <filesystem>

namespace tessera::io::helper {

/// Throws Error(bad_input) for what Xdmf's library would follow further than it should, or pass over: entities, other
/// files that are included, references, and numbers in the text that are fewer or more than their dimensions say.
void check_xdmf_elements(const std::filesystem::path& file);

}  // namespace tessera::io::helper
