// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/volume_tags.hpp"

#include <algorithm>

namespace tessera::io {
namespace {

constexpr std::string_view ras_space = "right-anterior-superior", lps_space = "left-posterior-superior";

}  // namespace

std::vector<std::pair<std::string, std::string>> tag_words(BodyAxes axes, const VolumeTags& tags) {
  std::vector<std::pair<std::string, std::string>> words;
  if (axes != BodyAxes::none) words.emplace_back("space", axes == BodyAxes::ras ? ras_space : lps_space);
  words.emplace_back("modality", tags.modality);
  words.emplace_back("unit", tags.unit);
  words.emplace_back("length unit", tags.length_unit);
  words.emplace_back("intent", tags.labels ? "label" : "");
  for (auto& [name, word] : words) std::erase_if(word, [](unsigned char c) { return c < 32 || c == '"' || c == 127; });
  std::erase_if(words, [](const auto& named) { return named.second.empty(); });
  return words;
}

std::string note_on(const VolumeTags& tags) {
  std::string note = tags.modality.empty() ? "" : "modality " + tags.modality;
  if (!tags.unit.empty()) note += (note.empty() ? "values in " : ", values in ") + tags.unit;
  return note;
}

void take_word(std::string_view name, std::string_view word, BodyAxes& axes, VolumeTags& tags) {
  if (name == "space" && word == ras_space) axes = BodyAxes::ras;
  if (name == "space" && word == lps_space) axes = BodyAxes::lps;
  if (name == "modality") tags.modality = word;
  if (name == "unit") tags.unit = word;
  if (name == "length unit") tags.length_unit = word;
  if (name == "intent") tags.labels = word == "label";
}

}  // namespace tessera::io
