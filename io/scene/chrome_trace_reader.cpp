// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/chrome_trace_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "io/files/whole_file.hpp"
#include "io/text/json_text.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"
#include "tessera/program/printable.hpp"

namespace tessera::io {
namespace {

constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// One event while its fields are parsed.
struct Event {
  std::string name, category, phase, role;
  double pid, tid, start_us, wall_us, cpu_us, frame, bytes, messages, tile, peer;

  void clear() {
    for (std::string* word : {&name, &category, &phase, &role}) word->clear();
    pid = tid = start_us = wall_us = absent;
    cpu_us = bytes = messages = 0;
    frame = tile = peer = -1;
  }
};

/// Receives the parser's events and builds spans from them.
class EventReader final : public nlohmann::json_sax<nlohmann::json> {
 public:
  EventReader(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  [[nodiscard]] TraceFile take() && {
    if (file_.spans.empty())
      throw scene::bad_input(fmt::format(
          "{}: it has no spans recorded by Tessera; give a file that tessera render wrote with `timing`", source_));
    return std::move(file_);
  }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(std::int64_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) override { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string&) override { return number(value); }
  bool binary(nlohmann::json::binary_t&) override { return true; }

  bool string(std::string& value) override {
    value = printable(value);  // `tessera timing` prints these names
    if (here() == Place::event) {
      if (key_ == "name") event_.name = value;
      if (key_ == "cat") event_.category = value;
      if (key_ == "ph") event_.phase = value;
    } else if (here() == Place::arguments) {
      if (key_ == "role") event_.role = value;
    } else if (here() == Place::run) {
      for (const auto& [name, word] : {std::pair{"version", &TraceRun::version},
                                       {"commit", &TraceRun::commit},
                                       {"build", &TraceRun::build},
                                       {"input", &TraceRun::input},
                                       {"exchange", &TraceRun::exchange},
                                       {"rasterizer", &TraceRun::rasterizer},
                                       {"integrator", &TraceRun::integrator}})
        if (key_ == name) file_.run.*word = value;
    }
    return true;
  }

  bool key(std::string& value) override {
    key_ = value;
    return true;
  }

  bool start_object(std::size_t) override {
    switch (here()) {
      case Place::outside:
        return enter(Place::root);
      case Place::root:
        return enter(key_ == "otherData" ? Place::run : Place::elsewhere);
      case Place::events:
        event_.clear();
        ++event_number_;
        return enter(Place::event);
      case Place::event:
        return enter(key_ == "args" ? Place::arguments : Place::elsewhere);
      default:
        return enter(Place::elsewhere);
    }
  }

  bool start_array(std::size_t) override {
    const bool holds_events = here() == Place::outside || (here() == Place::root && key_ == "traceEvents");
    return enter(holds_events ? Place::events : Place::elsewhere);
  }

  bool end_object() override {
    if (here() == Place::event) finish_event();
    return leave();
  }
  bool end_array() override { return leave(); }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
    throw not_json(text_, source_, position, error.what());
  }

 private:
  enum class Place { outside, root, run, events, event, arguments, elsewhere };

  [[nodiscard]] Place here() const { return places_.empty() ? Place::outside : places_.back(); }
  bool enter(Place place) {
    places_.push_back(place);
    return true;
  }
  bool leave() {
    places_.pop_back();
    key_.clear();
    return true;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw scene::bad_input(fmt::format("{}: event {} ({}): {}; correct it or trace the run again", source_,
                                       event_number_, quote(event_.name), what));
  }

  bool number(double value) {
    if (here() == Place::event) {
      for (const auto& [name, field] :
           {std::pair{"ts", &Event::start_us}, {"dur", &Event::wall_us}, {"pid", &Event::pid}, {"tid", &Event::tid}})
        if (key_ == name) event_.*field = value;
    } else if (here() == Place::arguments) {
      for (const auto& [name, field] : {std::pair{"cpu_us", &Event::cpu_us},
                                        {"frame", &Event::frame},
                                        {"bytes", &Event::bytes},
                                        {"messages", &Event::messages},
                                        {"tile", &Event::tile},
                                        {"peer", &Event::peer}})
        if (key_ == name) event_.*field = value;
    } else if (here() == Place::run) {
      for (const auto& [name, field] : {std::pair{"tets", &TraceRun::tets},
                                        {"parts", &TraceRun::parts},
                                        {"parts_in_double_precision", &TraceRun::parts_in_double_precision}})
        if (key_ == name) file_.run.*field = static_cast<std::uint64_t>(run_number(value, 9e15));
      for (const auto& [name, field] : {std::pair{"frames", &TraceRun::frames},
                                        {"width", &TraceRun::width},
                                        {"height", &TraceRun::height},
                                        {"ranks", &TraceRun::ranks},
                                        {"projectors", &TraceRun::projectors},
                                        {"compositors", &TraceRun::compositors},
                                        {"threads_per_rank", &TraceRun::threads}})
        if (key_ == name) file_.run.*field = static_cast<int>(run_number(value, 1e9));
    }
    return true;
  }

  [[nodiscard]] double run_number(double value, double most) const {
    if (value >= 0 && value <= most && value == std::floor(value)) return value;
    throw scene::bad_input(fmt::format("{}: otherData: {} is {}, but must be a whole number from 0 to {}; correct it",
                                       source_, key_, value, most));
  }

  /// Returns `value`. Fails unless it is a number within [least, most], and an integer if `whole`.
  [[nodiscard]] double checked(const char* name, double value, double least, double most, bool whole) const {
    if (std::isnan(value)) fail(fmt::format("{} is missing or not a number", name));
    if (value >= least && value <= most && !(whole && value != std::floor(value))) return value;
    fail(fmt::format("{} is {}, it must be {} from {} to {}", name, value, whole ? "a whole number" : "a number", least,
                     most));
  }

  void finish_event() {
    if (event_.category != "tessera" || event_.phase != "X") return;
    constexpr double most_us = 1e14, most_count = 9e15;  // most_us is three years; most_count is exact as a double
    FileSpan span;
    span.start_us = checked("ts", event_.start_us, -most_us, most_us, false);
    span.wall_us = checked("dur", event_.wall_us, 0, most_us, false);
    span.cpu_us = checked("cpu_us", event_.cpu_us, 0, most_us, false);
    span.rank = static_cast<std::int32_t>(checked("pid", event_.pid, 0, 1e9, true));
    span.thread = static_cast<std::uint32_t>(checked("tid", event_.tid, 0, 4e9, true));
    span.frame = static_cast<std::int32_t>(checked("frame", event_.frame, -1, 1e9, true));
    span.bytes = static_cast<std::uint64_t>(checked("bytes", event_.bytes, 0, most_count, true));
    span.messages = static_cast<std::uint64_t>(checked("messages", event_.messages, 0, most_count, true));
    span.tile = static_cast<std::int32_t>(checked("tile", event_.tile, -1, 1e9, true));
    span.peer = static_cast<std::int32_t>(checked("peer", event_.peer, -1, 1e9, true));
    if (event_.role == "projector")
      span.role = scene::TraceRole::projector;
    else if (event_.role == "compositor")
      span.role = scene::TraceRole::compositor;
    else if (!event_.role.empty())
      fail(fmt::format("role is {}, but must be projector or compositor", quote(event_.role)));
    span.stage = stage_number();
    file_.spans.push_back(span);
  }

  std::uint16_t stage_number() {
    constexpr std::size_t most_stages = 1000;
    if (event_.name.empty()) fail("name is missing");
    const auto [at, is_new] = stages_.try_emplace(event_.name, static_cast<std::uint16_t>(file_.stages.size()));
    if (is_new) {
      if (file_.stages.size() == most_stages) fail(fmt::format("more than {} kinds of stages", most_stages));
      file_.stages.push_back(event_.name);
    }
    return at->second;
  }

  std::string_view text_;
  const std::string& source_;
  std::vector<Place> places_;
  std::string key_;  ///< the most recent key
  Event event_;
  std::size_t event_number_ = 0;
  std::unordered_map<std::string, std::uint16_t> stages_;
  TraceFile file_;
};

}  // namespace

TraceFile parse_chrome_trace(std::string_view text, const std::string& source) {
  EventReader reader(text, source);
  nlohmann::json::sax_parse(text.begin(), text.end(), &reader);
  return std::move(reader).take();
}

TraceFile read_chrome_trace(const std::filesystem::path& file) {
  const WholeFile mapped(file);
  return parse_chrome_trace(mapped.text(), file.string());
}

}  // namespace tessera::io
