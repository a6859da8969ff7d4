// SPDX-License-Identifier: BSD-3-Clause
#include "apps/command_line.hpp"

#include <algorithm>

namespace tessera::apps {
namespace {

constexpr CommandRow rows[] = {
    {Trait::render, "render", "Render a mesh or a volume to images",
     "tessera render mesh.vtu -o image.png\ntessera render head.nii.gz --view left --color-bar -o head.png\n"
     "tessera render mesh.vtu --field p --transfer-function viridis --orbit 120 -o turn.mp4"},
    {Trait::serve, "serve", "Show a mesh or a volume in a browser, as it is turned and changed",
     "tessera serve mesh.vtu\nmpirun -n 4 tessera serve mesh.pvtu --port 8080"},
    {Trait::info, "info", "Print the contents of a mesh or volume and how it would be rendered",
     "tessera info mesh.vtu"},
    {Trait::convert, "convert", "Write a mesh as tetrahedra, or a volume, with one scalar",
     "tessera convert mesh.vtu mesh.tets"},
    {Trait::generate, "generate", "Make a mesh or a volume", "tessera generate cube cube.vtu n=16"},
    {Trait::chart, "chart", "Chart time against error of every method on this data and view", ""},
    {Trait::timing, "timing", "Print where traced runs spent their time", ""},
    {Trait::formats, "formats", "List the formats of files that are read, and known ones that are not", ""},
    {Trait::presets, "presets", "List the colour presets of --transfer-function, or draw them", ""},
    {Trait::help, "help", "Print the usage of a command", ""},
    {Trait::completion, "completion", "Print the script by which a shell completes words of tessera", ""}};

}  // namespace

std::span<const CommandRow> command_rows() { return rows; }

const CommandRow* command_named(std::string_view name) {
  const auto* const found = std::ranges::find(rows, name, &CommandRow::name);
  return found == std::end(rows) ? nullptr : found;
}

}  // namespace tessera::apps
