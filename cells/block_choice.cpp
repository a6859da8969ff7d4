// SPDX-License-Identifier: BSD-3-Clause
#include "cells/block_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "scene/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/printable.hpp"
#include "tessera/program/text.hpp"

namespace tessera::cells {
namespace {

std::string list(std::span<const std::string> blocks, bool with_surfaces) {
  const std::size_t most = with_surfaces ? blocks.size() : 12;  // limit for a readable line
  std::string text;
  for (const std::string& block : blocks.first(std::min(blocks.size(), most)))
    text += (text.empty() ? "" : ", ") + quote(block);
  if (blocks.size() > most) text += fmt::format(" and {} more, which `tessera info` lists", blocks.size() - most);
  return text;
}

}  // namespace

bool means_block(std::string_view name, std::string_view block) {
  if (name == block) return true;
  if (name.empty() || name.size() >= block.size()) return false;
  return (block.starts_with(name) && block[name.size()] == '/') ||
         (block.ends_with(name) && block[block.size() - name.size() - 1] == '/');
}

bool is_chosen(const BlockChoice& choice, std::string_view block) {
  return choice.empty() ||
         std::any_of(choice.begin(), choice.end(), [&](const std::string& name) { return means_block(name, block); });
}

void require_blocks(const BlockChoice& choice, std::span<const std::string> blocks, const std::string& source,
                    bool with_surfaces) {
  for (const std::string& name : choice) {
    if (std::any_of(blocks.begin(), blocks.end(), [&](const std::string& block) { return means_block(name, block); }))
      continue;
    std::string remedy = with_surfaces ? "give boundary or a file of triangles" : "leave `block` out";
    if (!blocks.empty()) remedy = "it has " + list(blocks, with_surfaces);
    if (const auto nearest = blocks.size() > 1 ? nearest_name(name, blocks) : std::nullopt)
      remedy += fmt::format("; the nearest is {}", quote(*nearest));
    throw scene::Error(
        scene::ErrorCode::bad_input, printable(source),
        fmt::format("there is no block {}{}", quote(name), blocks.empty() ? ": it has no named blocks" : ""), remedy);
  }
}

std::string note_on_surfaces(std::string_view what, std::span<const std::string> names) {
  constexpr std::size_t most = 20;
  std::string text;
  for (const std::string& name : names.first(std::min(names.size(), most)))
    text += (text.empty() ? "" : ", ") + quote(name);
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return names.size() == 1 ? fmt::format("1 {} is a surface and is left out: {} (`surface` shows it)", what, text)
                           : fmt::format("{} {}{} are surfaces and are left out: {} (`surface` shows them)",
                                         names.size(), what, what.ends_with("ch") ? "es" : "s", text);
}

std::vector<std::string> distinct_names(std::vector<std::string> names) {
  std::unordered_set<std::string> known{""};
  std::erase_if(names, [&](const std::string& name) { return !known.insert(name).second; });
  return names;
}

}  // namespace tessera::cells
