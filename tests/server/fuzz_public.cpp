// SPDX-License-Identifier: BSD-3-Clause
// The parts of the public API that the fuzzed sources call, without the rest.
#include <nlohmann/json.hpp>

#include "io/text/json_text.hpp"
#include "tessera/dataset.hpp"
#include "tessera/input_file.hpp"
#include "tessera/view.hpp"

namespace tessera {
inline namespace v0_1 {

void check_json(std::string_view text, const std::string& source, std::size_t most_values) {
  io::parse_json(text, source, most_values);
}
bool is_json_text(std::string_view file_or_json) { return io::is_json_text(file_or_json); }
std::vector<std::string> preset_names() { return {"cool-warm", "viridis"}; }

}  // namespace v0_1
}  // namespace tessera
