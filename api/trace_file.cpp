// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/trace_file.hpp"

#include <limits>

#include "api/communicator.hpp"
#include "exchange/collectives.hpp"
#include "io/scene/chrome_trace.hpp"
#include "io/scene/chrome_trace_reader.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

using exchange::Bytes;
using exchange::Channel;
using exchange::MessageKind;

constexpr int pings = 8;

/// The writer's clock minus this rank's clock, in microseconds. It is computed from the fastest of a few message
/// exchanges; its error is at most half the duration of that exchange.
double clock_offset(exchange::Transport& transport, int writer, const Trace& trace) {
  double offset = 0, quickest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < pings; ++i) {
    const double asked = trace.now_us();
    transport.send(writer, Channel::timing, exchange::begin_message(MessageKind::clock_question));
    const auto answer = transport.receive(Channel::timing);
    const double answered = trace.now_us();
    if (answered - asked >= quickest) continue;
    quickest = answered - asked;
    offset = exchange::value_of<double>(answer.bytes, answer.from, MessageKind::clock_answer) - (asked + answered) / 2;
  }
  return offset;
}

}  // namespace

void write_trace(const Trace& trace, const TraceRun& run, const std::filesystem::path& file) {
  const std::string events = io::chrome_trace_events(trace, 0, "rank 0");
  io::write_chrome_trace(std::span(&events, 1), run, file);
}

void write_trace(const Trace& trace, const std::string& process_name, const TraceRun& run,
                 const std::filesystem::path& file, const Communicator& communicator, int writer) {
  const std::shared_ptr<exchange::Transport> connection = StateAccess::of(communicator).connect();
  exchange::Transport& transport = *connection;
  const int self = transport.rank();
  if (self != writer) {
    const double offset = clock_offset(transport, writer, trace);
    Bytes message = exchange::begin_message(MessageKind::trace_events);
    exchange::append_text(message, io::chrome_trace_events(trace, self, process_name, offset));
    transport.send(writer, Channel::timing, std::move(message));
    return;
  }
  std::vector<std::string> events(static_cast<std::size_t>(transport.size()));
  events[static_cast<std::size_t>(self)] = io::chrome_trace_events(trace, self, process_name);
  for (int left = transport.size() - 1; left > 0;) {
    const auto message = transport.receive(Channel::timing);
    exchange::MessageReader reader(message.bytes, message.from);
    if (reader.kind() == MessageKind::clock_question) {
      transport.send(message.from, Channel::timing, exchange::message_of(MessageKind::clock_answer, trace.now_us()));
      continue;
    }
    if (reader.kind() != MessageKind::trace_events) reader.refuse_kind();
    events[static_cast<std::size_t>(message.from)] = reader.take_text();
    reader.finish();
    --left;
  }
  io::write_chrome_trace(events, run, file);
}

TraceFile read_trace(const std::filesystem::path& file) { return io::read_chrome_trace(file); }

}  // namespace v0_1
}  // namespace tessera
