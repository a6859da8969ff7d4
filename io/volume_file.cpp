#include "io/volume_file.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace tessera::io {

bool is_volume_file(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 11> endings = {".vti",  ".pvti", ".vtr", ".pvtr", ".mhd",   ".mha",
                                                        ".nrrd", ".nhdr", ".nii", ".raw",  ".bricks"};
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : static_cast<char>(c);
  });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return name.ends_with(ending); });
}

}  // namespace tessera::io
