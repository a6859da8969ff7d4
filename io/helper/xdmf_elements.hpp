#pragma once

#include <filesystem>

namespace tessera::io::helper {

/// Whether Xdmf's library takes a file's text as it is, or as rewritten_xdmf() gives it.
enum class XdmfText : bool { plain, to_be_rewritten };

/// Throws Error(bad_input) for what Xdmf's library would follow further than it should, or pass over: entities, other
/// files that are included, and numbers in the text that are fewer or more than their dimensions say.
XdmfText check_xdmf_elements(const std::filesystem::path& file);

}  // namespace tessera::io::helper
