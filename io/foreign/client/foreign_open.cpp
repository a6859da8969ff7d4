// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "cells/block_choice.hpp"
#include "io/foreign/client/foreign_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {

ForeignFile open_foreign(std::shared_ptr<HelperProcess> helper, const std::filesystem::path& file,
                         nlohmann::json request) {
  request["do"] = "open";
  request["version"] = helper_version;
  request["file"] = file.string();
  ForeignFile opened;
  opened.source = file.string();
  opened.with_surfaces = request.value("surfaces", false);
  const nlohmann::json reply = helper->call(request, opened.source);
  opened.arrays = std::move(helper);
  try {
    opened.contents = contents_of(reply.at("contents").get_binary());
  } catch (const std::exception&) {
    throw scene::bad_input(
        fmt::format("{}: its contents are inconsistent; write the file again, or in another format", opened.source));
  }
  ForeignContents& contents = opened.contents;
  if (!opened.with_surfaces && contents.parts.size() > 1)
    for (const ForeignPart& part : contents.parts)
      if (part.kind == ForeignPart::Kind::surface) contents.surface_names.push_back(part.name);
  if (!contents.block_names.empty()) return opened;  // the reader has checked the names
  for (const ForeignPart& part : contents.parts)
    if (part.kind != ForeignPart::Kind::surface || opened.with_surfaces) contents.block_names.push_back(part.name);
  const cells::BlockChoice choice = request.value("blocks", cells::BlockChoice());
  std::erase_if(contents.parts, [&](const ForeignPart& part) { return !cells::is_chosen(choice, part.name); });
  return opened;
}

ForeignFile open_foreign(const InputFile& file, nlohmann::json request, const ReadProgressFunction& progress,
                         HelperTask task) {
  task.progress = progress;
  task.format = file.format;
  return open_foreign(std::make_shared<HelperProcess>(std::move(task)), file.path, std::move(request));
}

}  // namespace tessera::io
