// SPDX-License-Identifier: BSD-3-Clause
// The cost of sending parts of an image to the pixels composited from them, by several exchanges, for
// bench/exchanges.py:
//
//   direct-send   exchange/direct/direct_send.hpp, as used by `--distribution sort-last`
//   binary-swap   Ma, Painter, Hansen, Krogh, "Parallel Volume Rendering Using Binary-Swap Compositing" (1994): rounds
//                 of pairs that exchange halves of what they have; for numbers of ranks that are not a power of two,
//                 the rounds use their prime factors
//   radix-k       Peterka, Goodell, Ross, Shen, Thakur, "A Configurable Algorithm for Parallel Image-Compositing
//                 Applications" (2009): rounds of four if the number of ranks allows, direct send within a round
//   runs          meshes: composited runs of touching ray segments from N projectors to N compositors of tiles, each
//                 rank as if on its own machine
//
//   compositing_exchanges [NAME=VALUE ...]     prints a JSON object per number of ranks and exchange; names and
//                                              defaults are those of `Run`
//
// Ranks are threads of one process; bytes and messages are exact, CPU time is that of the rank with most, the minimum
// of three repetitions. All exchanges pack pixels losslessly and send of each packet only the rectangle in which a part
// is visible. `error` is the largest difference from the image of the whole rendered by one process.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cpu_time.hpp"
#include "datasets/boxes.hpp"
#include "datasets/volumes.hpp"
#include "exchange/direct/direct_send.hpp"
#include "exchange/loopback_transport.hpp"
#include "exchange/message.hpp"
#include "exchange/packed_pixels.hpp"
#include "frame/mesh/render.hpp"
#include "frame/ranks/distributed.hpp"
#include "io/formats/identify.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "projection/partition.hpp"
#include "scene/error.hpp"
#include "scene/mesh_facts.hpp"
#include "scene/pixel_rect.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/render.hpp"
#include "volume/split/cost_map.hpp"
#include "volume/split/object_split.hpp"

namespace {

using namespace tessera;
using exchange::Transport;

struct Run {
  std::map<std::string, std::string> words{{"volume", ""},  {"mesh", ""},     {"ranks", "2,4,8"}, {"n", "128"},
                                           {"jitter", "0"}, {"size", "1024"}, {"views", "3"}};

  explicit Run(std::span<char*> arguments) {
    for (const std::string argument : arguments) {
      const std::size_t at = argument.find('=');
      const auto found = words.find(argument.substr(0, at));
      if (at == std::string::npos || found == words.end())
        throw scene::bad_input(
            fmt::format("compositing_exchanges: '{}' is not one of its parameters NAME=VALUE", argument));
      found->second = argument.substr(at + 1);
    }
  }
  [[nodiscard]] int whole(const char* name) const { return std::stoi(words.at(name)); }
  [[nodiscard]] double number(const char* name) const { return std::stod(words.at(name)); }
  [[nodiscard]] std::vector<int> ranks() const {
    std::vector<int> all;
    std::istringstream in(words.at("ranks"));
    for (std::string one; std::getline(in, one, ',');) all.push_back(std::stoi(one));
    return all;
  }
};

PixelRect hull(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

/// An image in parts, one per rank.
struct Parts {
  std::vector<scene::Image> images;
  std::vector<PixelRect> own;  ///< where each part is visible
  std::vector<int> order;      ///< ranks, front to back
  PixelRect area{};
  scene::Image whole;  ///< rendered by one process
};

/// The cost of an exchange.
struct Cost {
  std::uint64_t bytes = 0, messages = 0;  ///< over all ranks
  std::uint64_t most_bytes = 0;           ///< sent by one rank
  double cpu_seconds = 0;                 ///< of the rank with the largest time
  double error = 0;

  void add(std::uint64_t rank_bytes, std::uint64_t rank_messages, double rank_seconds) {
    bytes += rank_bytes, messages += rank_messages;
    most_bytes = std::max(most_bytes, rank_bytes), cpu_seconds = std::max(cpu_seconds, rank_seconds);
  }
};

/// Sizes of the groups in each round: factors of the number of ranks, `wanted` if it divides the remaining number,
/// otherwise the next smaller divisor, otherwise the next larger one.
std::vector<int> radices_of(int ranks, int wanted) {
  std::vector<int> radices;
  while (ranks > 1) {
    int k = wanted;
    while (k > 1 && ranks % k != 0) --k;
    if (k == 1)
      for (k = wanted + 1; ranks % k != 0;) ++k;
    radices.push_back(k);
    ranks /= k;
  }
  return radices;
}

/// One rank's part in rounds of swaps. Two ranks meet in only one round, so the sender identifies a message's round.
class Swap {
 public:
  /// `scratch` may have any size, and should be reused.
  Swap(Transport& transport, const Parts& parts, std::vector<int> radices, scene::Image& scratch)
      : transport_(transport),
        scratch_(scratch),
        parts_(parts),
        radices_(std::move(radices)),
        place_(static_cast<int>(std::find(parts.order.begin(), parts.order.end(), transport.rank()) -
                                parts.order.begin())),
        came_(parts.order.size()) {}

  /// Returns the region of `image` that is composited.
  PixelRect run(scene::Image& image) {
    PixelRect region = parts_.area;
    int stride = 1;
    for (const int k : radices_) {
      const int digit = place_ / stride % k, first = place_ - digit * stride;
      const PixelRect shows = block(place_ / stride, stride);
      for (int j = 1; j < k; ++j) {
        const int member = (digit + j) % k;
        const int to = first + member * stride;
        send(parts_.order[static_cast<std::size_t>(to)], scene::common(exchange::band_of(region, member, k), shows),
             image);
      }
      region = exchange::band_of(region, digit, k);
      for (int j = digit - 1; j >= 0; --j) composite(first + j * stride, stride, region, image, true);
      for (int j = digit + 1; j < k; ++j) composite(first + j * stride, stride, region, image, false);
      stride *= k;
    }
    return region;
  }
  std::uint64_t bytes = 0, messages = 0;

 private:
  /// Returns the rectangle that contains the visible parts of `stride` consecutive ranks in depth order.
  [[nodiscard]] PixelRect block(int number, int stride) const {
    PixelRect all{0, 0, 0, 0};
    for (int place = number * stride; place < (number + 1) * stride; ++place)
      all = hull(all, parts_.own[static_cast<std::size_t>(parts_.order[static_cast<std::size_t>(place)])]);
    return all;
  }

  void send(int to, const PixelRect& rect, const scene::Image& image) {
    exchange::Bytes message = exchange::message_of(exchange::MessageKind::packet, rect);
    if (!rect.empty()) exchange::append_pixels(message, image, rect, true);
    bytes += message.size(), ++messages;
    transport_.send(to, exchange::Channel::fragments, std::move(message), 0);
  }

  void composite(int place, int stride, const PixelRect& region, scene::Image& image, bool in_front) {
    const int from = parts_.order[static_cast<std::size_t>(place)];
    auto& message = came_[static_cast<std::size_t>(from)];
    while (!message) {
      exchange::Message next = transport_.receive(exchange::Channel::fragments);
      came_[static_cast<std::size_t>(next.from)] = std::move(next);
    }
    exchange::MessageReader reader(*message, exchange::MessageKind::packet);
    const auto r = reader.take<PixelRect>();
    if (const PixelRect expected = scene::common(region, block(place / stride, stride));
        !expected.empty() && (r.x0 != expected.x0 || r.y0 != expected.y0 || r.x1 != expected.x1 || r.y1 != expected.y1))
      throw scene::Error(scene::ErrorCode::system_failure,
                         "compositing_exchanges: a message contains the pixels of another rectangle");
    if (r.empty()) return;
    scratch_.size = {r.width(), r.height()};
    scratch_.depth.resize(static_cast<std::size_t>(r.width()) * static_cast<std::size_t>(r.height()));
    scratch_.rgba.resize(4 * scratch_.depth.size());
    exchange::take_pixels(reader, scratch_, {0, 0, r.width(), r.height()});
    for (int y = r.y0; y < r.y1; ++y)
      for (int x = r.x0; x < r.x1; ++x) {
        float* const mine = &image.rgba[4 * image.index(x, y)];
        const float* const other = &scratch_.rgba[4 * scratch_.index(x - r.x0, y - r.y0)];
        const float through = 1 - (in_front ? other[3] : mine[3]);
        for (int c = 0; c < 4; ++c) mine[c] = in_front ? other[c] + through * mine[c] : mine[c] + through * other[c];
      }
  }

  Transport& transport_;
  scene::Image& scratch_;
  const Parts& parts_;
  std::vector<int> radices_;
  int place_;
  std::vector<std::optional<exchange::Message>> came_;  ///< by sender
};

double difference(const scene::Image& a, const scene::Image& b, const PixelRect& rect) {
  double most = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x)
      for (std::size_t c = 0; c < 4; ++c)
        most = std::max(most, std::fabs(double{a.rgba[4 * a.index(x, y) + c]} - b.rgba[4 * b.index(x, y) + c]));
  return most;
}

/// `composite(transport, image, cost)` returns the rank's finished region.
template <class Composite>
Cost measured(const Parts& parts, const Composite& composite) {
  Cost least;
  for (int repetition = 0; repetition < 3; ++repetition) {
    const std::size_t ranks = parts.images.size();
    std::vector<Cost> each(ranks);
    exchange::run_ranks(static_cast<int>(ranks), [&](Transport& transport) {
      const auto rank = static_cast<std::size_t>(transport.rank());
      scene::Image image = parts.images[rank];
      const double begin = bench::thread_seconds();
      const PixelRect region = composite(transport, image, each[rank]);
      each[rank].cpu_seconds = bench::thread_seconds() - begin;
      each[rank].error = difference(image, parts.whole, region);
    });
    Cost cost;
    for (const Cost& of : each) {
      cost.add(of.bytes, of.messages, of.cpu_seconds);
      cost.error = std::max(cost.error, of.error);
    }
    if (repetition == 0 || cost.cpu_seconds < least.cpu_seconds) least = cost;
  }
  return least;
}

Cost direct_send(const Parts& parts) {
  const std::vector<int> bands = exchange::band_numbers(parts.own);
  return measured(parts, [&](Transport& transport, scene::Image& image, Cost& cost) {
    const auto rank = static_cast<std::size_t>(transport.rank());
    exchange::DirectSender sender(transport);
    const exchange::DirectSendTask task{parts.order, bands, parts.area, parts.own[rank], 0, false, nullptr};
    const exchange::DirectSendResult sent = sender.run(DirectSend::asynchronous, task, image, {});
    cost.bytes = sent.bytes, cost.messages = sent.messages;
    return exchange::band_of(parts.area, bands[rank], transport.size());
  });
}

Cost swaps(const Parts& parts, int wanted) {
  std::vector<scene::Image> scratch(parts.images.size());
  return measured(parts, [&](Transport& transport, scene::Image& image, Cost& cost) {
    Swap swap(transport, parts, radices_of(transport.size(), wanted),
              scratch[static_cast<std::size_t>(transport.rank())]);
    const PixelRect region = swap.run(image);
    cost.bytes = swap.bytes, cost.messages = swap.messages;
    return region;
  });
}

scene::Camera camera_at(const Run& run, int view, const scene::Box& box) {
  const double angle = 2 * std::numbers::pi * view / run.whole("views") + 0.3;
  scene::Camera camera;
  camera.projection = scene::ProjectionKind::perspective;
  camera.view_angle = 30;
  camera.view_up = {0, 1, 0};
  camera.focal_point = 0.5 * (box.low + box.high);
  camera.position = camera.focal_point + 1.9 * glm::length(box.high - box.low) *
                                             glm::normalize(glm::dvec3(std::cos(angle), 0.3, std::sin(angle)));
  return camera;
}

void print(int ranks, const char* exchange, std::span<const Cost> views, const std::string& more = "") {
  Cost sum;
  for (const Cost& cost : views) {
    sum.bytes += cost.bytes, sum.messages += cost.messages, sum.most_bytes += cost.most_bytes;
    sum.cpu_seconds += cost.cpu_seconds, sum.error = std::max(sum.error, cost.error);
  }
  const double each = 1.0 / static_cast<double>(views.size());
  fmt::print(
      "{{\"ranks\": {}, \"exchange\": \"{}\", \"bytes\": {:.0f}, \"most_bytes\": {:.0f}, \"messages\": {:.0f}, "
      "\"cpu_ms\": {:.3f}, \"error\": {:.2e}{}}}\n",
      ranks, exchange, each * static_cast<double>(sum.bytes), each * static_cast<double>(sum.most_bytes),
      each * static_cast<double>(sum.messages), 1e3 * each * sum.cpu_seconds, sum.error, more);
}

void print_composited(int ranks, std::span<const Parts> views) {
  std::vector<Cost> direct, binary, radix;
  for (const Parts& parts : views) {
    direct.push_back(direct_send(parts));
    binary.push_back(swaps(parts, 2));
    radix.push_back(swaps(parts, 4));
  }
  print(ranks, "direct-send", direct);
  print(ranks, "binary-swap", binary);
  print(ranks, "radix-k", radix);
}

void of_volume(const Run& run) {
  const auto source = datasets::generate_volume(run.words.at("volume"), {{"n", run.number("n")}, {"bits", 8}});
  const auto ranges = std::make_shared<const volume::CellRanges>(*source);
  const scene::TransferFunction function(
      {{0, {0.1, 0.2, 0.8}, 0.1}, {128, {0.9, 0.8, 0.3}, 0.4}, {255, {1, 0.3, 0.1}, 1}});
  const scene::ImageSize size{run.whole("size"), run.whole("size")};
  for (const int ranks : run.ranks()) {
    volume::RenderSettings settings;
    settings.parts = ranks;
    volume::Renderer renderer(*source, settings, ranges);
    const volume::ObjectSplit split = renderer.object_split(function, ranks);
    std::vector<Parts> views(static_cast<std::size_t>(run.whole("views")));
    for (std::size_t v = 0; v < views.size(); ++v) {
      Parts& parts = views[v];
      const scene::Camera camera = camera_at(run, static_cast<int>(v), bounds(renderer.geometry()));
      parts.whole = renderer.render(camera, size, function).image;
      parts.area = volume::footprint(camera, size, renderer.geometry());
      parts.order = split.front_to_back(renderer.geometry(), camera);
      for (const volume::VoxelBox& box : split.boxes()) {
        parts.own.push_back(scene::common(parts.area, volume::footprint(camera, size, renderer.geometry(), box)));
        parts.images.push_back(
            renderer.render(camera, size, function, {.regions = {parts.own.back()}, .part = box}).image);
      }
    }
    print_composited(ranks, views);
  }
}

/// The tets of a part, with the whole mesh's vertices.
scene::TetMesh part_of(const scene::TetMesh& mesh, std::span<const std::uint32_t> parts, std::uint32_t part,
                       std::vector<std::uint64_t>& global) {
  scene::TetMesh some = mesh;
  some.tets.clear();
  if (mesh.association == scene::Association::cell) some.scalars.clear();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (parts[t] != part) continue;
    some.tets.push_back(mesh.tets[t]);
    if (mesh.association == scene::Association::cell) some.scalars.push_back(mesh.scalars[t]);
    global.push_back(t);
  }
  return some;
}

struct MeshParts {
  std::vector<scene::TetMesh> meshes;
  std::vector<std::vector<std::uint64_t>> global;
  std::vector<glm::dvec3> centres;
};

MeshParts divided(const scene::TetMesh& mesh, int ranks) {
  const std::vector<std::uint32_t> of = projection::parts_of_whole(mesh, {PartitionKind::curve, 1}, ranks);
  MeshParts parts;
  parts.global.resize(static_cast<std::size_t>(ranks));
  for (std::uint32_t p = 0; p < static_cast<std::uint32_t>(ranks); ++p) {
    parts.meshes.push_back(part_of(mesh, of, p, parts.global[p]));
    glm::dvec3 sum(0);
    for (const auto& tet : parts.meshes.back().tets)
      for (const std::uint32_t v : tet) sum += mesh.positions[v];
    parts.centres.push_back(sum / std::max(1.0, 4.0 * static_cast<double>(parts.meshes.back().tets.size())));
  }
  return parts;
}

Parts pictures_of(const MeshParts& meshes, const Settings& settings, const scene::TransferFunction& function,
                  const scene::Camera& camera, scene::ImageSize size, scene::Image whole, std::uint64_t& covered) {
  Parts parts;
  parts.whole = std::move(whole);
  for (const scene::TetMesh& mesh : meshes.meshes) {
    parts.images.push_back(frame::Renderer(mesh, settings).render(camera, size, function));
    PixelRect own{0, 0, 0, 0};
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        if (parts.images.back().rgba[4 * parts.whole.index(x, y) + 3] != 0)
          own = hull(own, {x, y, x + 1, y + 1}), ++covered;
    parts.own.push_back(own);
    parts.area = hull(parts.area, own);
  }
  parts.order.resize(meshes.meshes.size());
  std::iota(parts.order.begin(), parts.order.end(), 0);
  std::ranges::sort(parts.order, {}, [&](int rank) {
    return glm::distance(camera.position, meshes.centres[static_cast<std::size_t>(rank)]);
  });
  return parts;
}

/// Measures the exchange of runs from N projectors to N compositors. The number of fragments is added to `fragments`.
std::vector<Cost> runs(const MeshParts& parts, const scene::MeshFacts& facts, const Settings& settings,
                       const scene::TransferFunction& function, std::span<const frame::FrameJob> jobs,
                       std::span<const Parts> views, std::uint64_t& fragments) {
  std::vector<Cost> costs(jobs.size());
  const int ranks = static_cast<int>(parts.meshes.size());
  exchange::run_ranks(ranks, [&](Transport& transport) {
    frame::DistributedSettings mine;
    mine.render = settings;
    mine.roles = assign_roles(ranks, ranks, ranks);
    mine.render.use.sharing = false;
    frame::render_distributed(
        transport, mine, jobs, function,
        [&](std::size_t) {
          const auto rank = static_cast<std::size_t>(transport.rank());
          frame::ProjectorMesh mesh;
          mesh.part = parts.meshes[rank];
          mesh.global_tet = parts.global[rank];
          mesh.diagonal = glm::length(facts.box.high - facts.box.low);
          mesh.box = facts.box;
          mesh.scalar_range = facts.scalar_range;
          return mesh;
        },
        [&](const frame::FinishedFrame& frame) {
          Cost& cost = costs[frame.frame];
          cost.bytes = frame.statistics.exchange_bytes, cost.messages = frame.statistics.exchange_messages;
          cost.error = difference(frame.image, views[frame.frame].whole,
                                  {0, 0, frame.image.size.width, frame.image.size.height});
          fragments += frame.statistics.fragments;
        });
  });
  return costs;
}

void of_mesh(const Run& run) {
  const std::string& file = run.words.at("mesh");
  const scene::TetMesh mesh =
      file == "cube" ? datasets::cube(run.whole("n"), run.number("jitter")) : io::read_mesh(io::identify(file)).mesh;
  const scene::MeshFacts facts = scene::facts_of(mesh);
  const auto [low, high] = facts.scalar_range;
  const double k = 1 / glm::length(facts.box.high - facts.box.low);
  const scene::TransferFunction function(
      {{low, {0.1, 0.2, 0.8}, 0.1 * k}, {0.5 * (low + high), {0.9, 0.8, 0.3}, 0.4 * k}, {high, {1, 0.3, 0.1}, k}});
  const scene::ImageSize size{run.whole("size"), run.whole("size")};
  Settings settings;
  std::vector<frame::FrameJob> jobs;
  std::vector<scene::Image> whole;
  frame::Renderer renderer(mesh, settings);
  for (int v = 0; v < run.whole("views"); ++v) {
    jobs.push_back({camera_at(run, v, facts.box), size, 0});
    whole.push_back(renderer.render(jobs.back().camera, size, function));
  }
  settings.threads = 1;
  for (const int ranks : run.ranks()) {
    const MeshParts parts = divided(mesh, ranks);
    std::vector<Parts> views;
    std::uint64_t covered = 0, fragments = 0;
    for (std::size_t v = 0; v < jobs.size(); ++v)
      views.push_back(pictures_of(parts, settings, function, jobs[v].camera, size, whole[v], covered));
    const std::vector<Cost> sent = runs(parts, facts, settings, function, jobs, views, fragments);
    print(ranks, "runs", sent,
          fmt::format(", \"runs_a_part\": {:.3f}", static_cast<double>(fragments) / static_cast<double>(covered)));
    print_composited(ranks, views);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Run run(std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
    run.words.at("mesh").empty() ? of_volume(run) : of_mesh(run);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "%s\n", fault.what());
    return 2;
  }
  return 0;
}
