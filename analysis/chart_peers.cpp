// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/chart_peers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tessera/error.hpp"
#include "tessera/input_file.hpp"

namespace tessera::analysis {
namespace {

Image read_pfm(const std::filesystem::path& file, ImageSize size) {
  const std::string bytes = read_text(file);
  std::istringstream head(bytes);
  std::string magic;
  int width = 0, height = 0;
  double scale = 0;
  head >> magic >> width >> height >> scale;
  const auto begin = static_cast<std::size_t>(head.tellg()) + 1;
  const auto values = 3 * static_cast<std::size_t>(std::max(width, 0)) * static_cast<std::size_t>(std::max(height, 0));
  if (!head || magic != "PF" || scale >= 0 || begin + 4 * values != bytes.size())
    throw bad_input(fmt::format("{}: it is not a little-endian colour .pfm; write PF, size, -1.0", file.string()));
  if (width != size.width || height != size.height)
    throw bad_input(fmt::format("{}: it is {}x{} pixels, but the chart is {}x{}; render both at the same size",
                                file.string(), width, height, size.width, size.height));
  Image image(size);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at =
          static_cast<std::size_t>(height - 1 - y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      std::memcpy(&image.rgba[4 * image.index(x, y)], bytes.data() + begin + 12 * at, 12);
    }
  return image;
}

}  // namespace

std::vector<ChartPoint> read_peers(const std::filesystem::path& file, ImageSize size,
                                   std::span<const PixelIndex> pixels, std::span<const ReferencePixel> truths) {
  const std::string text = read_text(file);
  check_json(text, file.string());
  const nlohmann::json list = nlohmann::json::parse(text);
  std::vector<ChartPoint> points;
  try {
    for (const auto& entry : list) {
      ChartPoint point;
      point.family = entry.at("family").get<std::string>();
      point.name = entry.at("name").get<std::string>();
      if (entry.contains("left_out")) {
        point.left_out = entry.at("left_out").get<std::string>();
      } else {
        point.frame_ms = entry.at("frame_ms").get<std::vector<double>>();
        const auto picture = file.parent_path() / entry.at("picture").get<std::string>();
        point.error = chart_error(read_pfm(picture, size), pixels, truths, 3);
      }
      points.push_back(std::move(point));
    }
  } catch (const nlohmann::json::exception& error) {
    throw bad_input(fmt::format("{}: {}; write a list of objects with family, name, frame_ms and picture",
                                file.string(), error.what()));
  }
  return points;
}

}  // namespace tessera::analysis
