// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/chrome_trace.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "system/atomic_file.hpp"

namespace tessera::io {
namespace {

using scene::TraceRole;
using scene::TraceSpan;

/// Number of the first track of frames. Frames have separate tracks, because they would not nest with the spans of a
/// thread.
constexpr std::uint32_t frame_track = 1'000'000;

const char* word(TraceRole role) {
  return role == TraceRole::projector ? "projector" : role == TraceRole::compositor ? "compositor" : "both";
}

std::string quoted(const std::string& text) {
  // With `replace`, a name that is not UTF-8 does not make the trace invalid.
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Text of the elements of an array, one per line. A run has many events, and the time to write them is part of the
/// run. Numbers are therefore formatted without format strings, in a third of the time.
class EventText {
 public:
  EventText(int rank, std::size_t spans) : rank_(std::to_string(rank)) { text_.reserve(1000 + 140 * spans); }

  /// `value` must be JSON.
  void add_metadata(const char* name, std::uint32_t track, const char* argument, const std::string& value) {
    next();
    text_ += fmt::format(R"({{"name":"{}","ph":"M","pid":{},"tid":{},"args":{{"{}":{}}}}})", name, rank_, track,
                         argument, value);
  }

  void add(const TraceSpan& span, std::uint32_t track, double offset_us) {
    next();
    text_ += R"({"name":")";
    text_ += span.stage;
    text_ += R"(","cat":"tessera","ph":"X","pid":)";
    text_ += rank_;
    count(R"(,"tid":)", track);
    time(R"(,"ts":)", span.start_us + offset_us);
    time(R"(,"dur":)", span.wall_us);
    time(R"(,"args":{"cpu_us":)", span.cpu_us);
    if (span.role != TraceRole::both) {
      text_ += R"(,"role":")";
      text_ += word(span.role);
      text_ += '"';
    }
    if (span.frame >= 0) count(R"(,"frame":)", static_cast<std::uint64_t>(span.frame));
    if (span.bytes > 0) count(R"(,"bytes":)", span.bytes);
    if (span.messages > 0) count(R"(,"messages":)", span.messages);
    if (span.tile >= 0) count(R"(,"tile":)", static_cast<std::uint64_t>(span.tile));
    if (span.peer >= 0) count(R"(,"peer":)", static_cast<std::uint64_t>(span.peer));
    text_ += "}}";
  }

  [[nodiscard]] std::string array() && {
    text_ += ']';
    return std::move(text_);
  }

 private:
  void next() { text_ += text_.empty() ? "[" : ",\n"; }

  void count(std::string_view before, std::uint64_t number) {
    text_ += before;
    const fmt::format_int digits(number);
    text_.append(digits.data(), digits.size());
  }

  /// Microseconds with nanosecond resolution: three digits after the point.
  void time(std::string_view before, double us) {
    const auto ns = static_cast<std::int64_t>(std::llround(us * 1000));
    text_ += before;
    if (ns < 0) text_ += '-';
    const std::uint64_t size = ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
    count("", size / 1000);
    const auto rest = static_cast<int>(size % 1000);
    const std::array<char, 4> fraction = {'.', static_cast<char>('0' + rest / 100),
                                          static_cast<char>('0' + rest / 10 % 10), static_cast<char>('0' + rest % 10)};
    text_.append(fraction.data(), fraction.size());
  }

  std::string rank_, text_;
};

/// Adds frames. Frames that overlap, because several are rendered at the same time, get parallel tracks: as few as
/// possible for each role.
void add_frames(std::vector<TraceSpan> frames, double offset_us, EventText& events) {
  std::stable_sort(frames.begin(), frames.end(),
                   [](const TraceSpan& a, const TraceSpan& b) { return a.start_us < b.start_us; });
  std::array<std::vector<double>, 3> ends;  // end of the last span, per role and track
  for (const TraceSpan& frame : frames) {
    const auto role = static_cast<std::uint32_t>(frame.role);
    std::vector<double>& tracks = ends[role];
    const auto free = std::find_if(tracks.begin(), tracks.end(), [&](double end) { return end <= frame.start_us; });
    const auto lane = static_cast<std::size_t>(free - tracks.begin());
    const auto track = frame_track + 1000 * role + static_cast<std::uint32_t>(lane);
    if (free == tracks.end()) {
      events.add_metadata(
          "thread_name", track, "name",
          frame.role == TraceRole::both ? R"("frames")" : fmt::format(R"("{} frames")", word(frame.role)));
      events.add_metadata("thread_sort_index", track, "sort_index", "-1");
      tracks.push_back(0);
    }
    tracks[lane] = frame.start_us + frame.wall_us;
    events.add(frame, track, offset_us);
  }
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

nlohmann::ordered_json to_json(const TraceRun& run) {
  nlohmann::ordered_json json = {{"program", "tessera"}};
  const auto add_word = [&](const char* name, const std::string& text) {
    if (!text.empty()) json[name] = text;
  };
  const auto add_number = [&](const char* name, auto number) {
    if (number > 0) json[name] = number;
  };
  add_word("version", run.version);
  add_word("commit", run.commit);
  add_word("build", run.build);
  add_word("input", run.input);
  add_number("tets", run.tets);
  add_number("frames", run.frames);
  add_number("width", run.width);
  add_number("height", run.height);
  add_number("ranks", run.ranks);
  add_number("projectors", run.projectors);
  add_number("compositors", run.compositors);
  add_number("threads_per_rank", run.threads);
  add_number("parts", run.parts);
  add_number("parts_in_double_precision", run.parts_in_double_precision);
  add_word("exchange", run.exchange);
  add_word("rasterizer", run.rasterizer);
  add_word("integrator", run.integrator);
  return json;
}

}  // namespace

std::string chrome_trace_events(const scene::Trace& trace, int rank, const std::string& process_name,
                                double offset_us) {
  const std::vector<TraceSpan> spans = trace.spans();
  EventText events(rank, spans.size());
  events.add_metadata("process_name", 0, "name", quoted(process_name));
  events.add_metadata("process_sort_index", 0, "sort_index", std::to_string(rank));
  if (const std::string host = host_name(); !host.empty())
    events.add_metadata("process_labels", 0, "labels", quoted("host " + host));

  std::vector<TraceSpan> frames;
  std::map<std::uint32_t, std::array<bool, 3>> roles_of_thread;
  for (const TraceSpan& span : spans)
    if (std::string_view(span.stage) == "frame")
      frames.push_back(span);
    else
      roles_of_thread[span.thread][static_cast<std::size_t>(span.role)] = true;
  for (const auto& [thread, roles] : roles_of_thread) {
    const bool projects = roles[static_cast<std::size_t>(TraceRole::projector)];
    const bool composites = roles[static_cast<std::size_t>(TraceRole::compositor)];
    const char* role = projects == composites ? "" : projects ? "projector " : "compositor ";
    events.add_metadata("thread_name", thread, "name", fmt::format(R"("{}thread {}")", role, thread));
  }
  add_frames(std::move(frames), offset_us, events);
  for (const TraceSpan& span : spans)
    if (std::string_view(span.stage) != "frame") events.add(span, span.thread, offset_us);
  return std::move(events).array();
}

void write_chrome_trace(std::span<const std::string> events_of_ranks, const TraceRun& run,
                        const std::filesystem::path& file) {
  system::AtomicFile output(file);
  output.write(R"({"displayTimeUnit":"ms","otherData":)");
  output.write(to_json(run).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  output.write(",\n\"traceEvents\":[");
  const char* separator = "\n";
  for (const std::string& events : events_of_ranks) {
    if (events.size() <= 2) continue;  // empty, or []
    output.write(separator);
    output.write(std::string_view(events).substr(1, events.size() - 2));
    separator = ",\n";
  }
  output.write("\n]}\n");
  output.commit();
}

}  // namespace tessera::io
