#include "io/volume_formats.hpp"

namespace tessera::io {

bool has_quoted(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word, 1); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const char quote = text[at - 1];
    if (end < text.size() && (quote == '"' || quote == '\'') && text[end] == quote) return true;
  }
  return false;
}

bool looks_like_vtk_grid(std::string_view beginning) {
  if (beginning.starts_with("# vtk DataFile")) {
    const std::size_t at = beginning.find("DATASET");
    if (at == std::string_view::npos) return false;
    const std::string_view kind = beginning.substr(at + 7, 40);
    const std::size_t word = kind.find_first_not_of(" \t");
    return word != std::string_view::npos &&
           (kind.substr(word).starts_with("STRUCTURED_POINTS") || kind.substr(word).starts_with("RECTILINEAR_GRID"));
  }
  const std::size_t element = beginning.find("<VTKFile");
  if (element == std::string_view::npos) return false;
  const std::string_view tag = beginning.substr(element, beginning.find('>', element) - element);
  return has_quoted(tag, "ImageData") || has_quoted(tag, "PImageData") || has_quoted(tag, "RectilinearGrid") ||
         has_quoted(tag, "PRectilinearGrid");
}

}  // namespace tessera::io
