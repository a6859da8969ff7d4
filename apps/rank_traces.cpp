#include "apps/rank_traces.hpp"

#include <cstring>
#include <limits>

#include "exchange/wire.hpp"

namespace tessera::apps {
namespace {

using exchange::Bytes;
using exchange::Channel;

constexpr int pings = 8;

/// The writer's clock less this rank's, in microseconds: from the quickest of a few exchanges, whose error is at most
/// half its duration.
double clock_offset(exchange::Transport& transport, int writer, const scene::Trace& trace) {
  double offset = 0, quickest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < pings; ++i) {
    const double asked = trace.now_us();
    transport.send(writer, Channel::timing, Bytes(1));
    const auto answer = transport.receive(Channel::timing);
    const double answered = trace.now_us();
    if (answered - asked >= quickest) continue;
    quickest = answered - asked;
    offset = exchange::RecordReader(answer.bytes).take<double>() - (asked + answered) / 2;
  }
  return offset;
}

}  // namespace

void write_rank_traces(exchange::Transport& transport, int writer, const scene::Trace& trace,
                       const std::string& process_name, const io::TraceRun& run, const std::filesystem::path& file) {
  const int self = transport.rank();
  if (self != writer) {
    const double offset = clock_offset(transport, writer, trace);
    const std::string events = io::chrome_trace_events(trace, self, process_name, offset);
    Bytes message(events.size() + 2);  // longer than a ping, even if there are none
    std::memcpy(message.data() + 2, events.data(), events.size());
    transport.send(writer, Channel::timing, std::move(message));
    return;
  }
  std::vector<std::string> events(static_cast<std::size_t>(transport.size()));
  events[static_cast<std::size_t>(self)] = io::chrome_trace_events(trace, self, process_name);
  for (int left = transport.size() - 1; left > 0;) {
    const auto message = transport.receive(Channel::timing);
    if (message.bytes.size() == 1) {
      Bytes now;
      exchange::append(now, trace.now_us());
      transport.send(message.from, Channel::timing, std::move(now));
      continue;
    }
    events[static_cast<std::size_t>(message.from)] =
        std::string(reinterpret_cast<const char*>(message.bytes.data()) + 2, message.bytes.size() - 2);
    --left;
  }
  io::write_chrome_trace(events, run, file);
}

}  // namespace tessera::apps
