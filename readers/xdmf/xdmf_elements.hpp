// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tessera::readers {

/// Whether Xdmf's library gets a file's text unchanged, or from rewritten_xdmf().
enum class XdmfText : bool { plain, to_be_rewritten };

/// Throws Error(bad_input) for features that Xdmf's library would follow too far, or ignore: entities, included files,
/// and numbers in the text that are fewer or more than their dimensions state.
XdmfText check_xdmf_elements(const std::filesystem::path& file);

/// In a topology: the number of its first point.
constexpr const char* base_offset = "BaseOffset";

/// Whether a TopologyType is that of a three-dimensional grid, whose size may be its NumberOfElements.
bool is_structured(const std::string& topology_type);

/// Whether a GeometryType is that of points stored in one array per axis.
bool is_of_three_arrays(const std::string& geometry_type);

/// Whether an ItemType is a HyperSlab in any spelling.
bool is_selection(const std::string& item_type);

/// The name by which Xdmf's library identifies numbers of 1, 2 and 8 bytes, if it interprets the file's name as 4
/// bytes.
std::optional<std::string> library_type(const std::string& number_type, const std::string& precision);

}  // namespace tessera::readers
