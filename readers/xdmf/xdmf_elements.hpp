// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tessera::readers {

/// Whether Xdmf's library takes a file's text as it is, or as rewritten_xdmf() gives it.
enum class XdmfText : bool { plain, to_be_rewritten };

/// Throws Error(bad_input) for what Xdmf's library would follow further than it should, or pass over: entities, other
/// files that are included, and numbers in the text that are fewer or more than their dimensions say.
XdmfText check_xdmf_elements(const std::filesystem::path& file);

/// Of a topology: the number of its first point.
constexpr const char* base_offset = "BaseOffset";

/// Whether a TopologyType is that of a grid in three dimensions, whose size may be its NumberOfElements.
bool is_structured(const std::string& topology_type);

/// Whether a GeometryType is that of points by an array for each axis.
bool is_of_three_arrays(const std::string& geometry_type);

/// Whether an ItemType is a HyperSlab in any spelling.
bool is_selection(const std::string& item_type);

/// The name by which Xdmf's library knows numbers of 1, 2 and 8 bytes, where it takes the file's name as 4 bytes.
std::optional<std::string> library_type(const std::string& number_type, const std::string& precision);

}  // namespace tessera::readers
