// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tessera::readers {

/// Whether Xdmf's library reads the text of the file itself, or the text that rewritten_xdmf() returns.
enum class XdmfText : bool { plain, to_be_rewritten };

/// Throws Error(bad_input) for features that Xdmf's library would follow without a limit, or ignore: entities, included
/// files, and numbers in the text whose count differs from the stated dimensions.
XdmfText check_xdmf_elements(const std::filesystem::path& file);

/// Name of the attribute of a topology that contains the number of the first point.
constexpr const char* base_offset = "BaseOffset";

/// Whether a TopologyType is that of a three-dimensional grid, whose NumberOfElements may state the size.
bool is_structured(const std::string& topology_type);

/// Whether a GeometryType is that of points whose coordinates are in three arrays, one per axis.
bool is_of_three_arrays(const std::string& geometry_type);

/// Whether an ItemType is a HyperSlab, in any spelling.
bool is_selection(const std::string& item_type);

/// Returns the name by which Xdmf's library identifies numbers of 1, 2 and 8 bytes, if the library would interpret the
/// file's name as a type of 4 bytes.
std::optional<std::string> library_type(const std::string& number_type, const std::string& precision);

}  // namespace tessera::readers
