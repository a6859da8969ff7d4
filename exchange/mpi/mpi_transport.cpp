// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/mpi/mpi_transport.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "exchange/mailboxes.hpp"
#include "exchange/message.hpp"
#include "exchange/mpi/liveness.hpp"
#include "exchange/mpi/mpi_port.hpp"
#include "exchange/mpi/naps.hpp"
#include "exchange/mpi/send_queue.hpp"
#include "exchange/run_faults.hpp"
#include "scene/start_thread.hpp"

namespace tessera::exchange {
namespace {

using Clock = std::chrono::steady_clock;

// Tags below channel_count are channels; this one is for the transport's own messages.
constexpr int own_tag = 100;  // of kinds `fault` to `silent` (message.hpp)

/// Time for the others to receive the error of a stalled rank; at most the transport's patience.
constexpr auto stall_grace = std::chrono::seconds(1);

}  // namespace

/// The thread that calls MPI, and the data that it shares with other threads.
class MpiTransport::Engine {
 public:
  /// `borrowed` is a caller's communicator. Without it, the engine uses MPI's world, which it starts and ends.
  Engine(Hooks hooks, std::chrono::milliseconds patience, std::optional<int> borrowed)
      : hooks_(std::move(hooks)),
        patience_(patience),
        borrowed_(borrowed.has_value()),
        port_(borrowed),
        thread_(scene::start_thread([this] { run(); })) {
    if (const std::optional<scene::Error> error = start_error_.get_future().get()) {
      thread_.join();
      throw scene::Error(*error);
    }
  }
  ~Engine() {
    if (thread_.joinable()) finish();
  }

  void send(int to, Channel channel, Bytes bytes, std::int32_t frame) {
    if (mailboxes.failed()) return;
    constexpr std::size_t most_bytes = std::size_t{1} << 30;  // MPI counts in int
    if (bytes.size() > most_bytes)
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("rank {} of {}: a message of {} bytes is too long; make `tile_size` smaller", rank,
                                     size, bytes.size()));
    if (to == rank) {
      mailboxes.deliver(channel, {rank, std::move(bytes)});
      return;
    }
    sent.add(channel, bytes.size());
    enqueue({to, static_cast<int>(channel), std::move(bytes), frame});
  }

  void fail(const scene::Error& error) {
    {
      const std::lock_guard lock(mutex_);
      if (!own_fault_) own_fault_ = error;
    }
    naps.wake(rank);
  }

  std::optional<scene::Error> finish() {
    {
      const std::lock_guard lock(mutex_);
      finishing_ = true;
    }
    naps.wake(rank);
    if (thread_.joinable()) thread_.join();
    return mailboxes.error();
  }

  int rank = 0, size = 1;
  Mailboxes mailboxes;
  TrafficCounters sent;
  SendQueue queue;
  Naps naps;
  Liveness liveness;

 private:
  void enqueue(SendQueue::Outgoing message) {
    queue.push(std::move(message));
    naps.wake(rank);
  }

  bool start() {
    std::optional<scene::Error> failed;
    try {
      port_.start();
      rank = port_.rank();
      size = port_.size();
    } catch (const scene::Error& error) {
      failed = error;
    }
    const bool has_started = !failed;
    start_error_.set_value(std::move(failed));
    return has_started;
  }

  void run() {
    if (!start()) return;
    while (!all_clear_) {
      const std::shared_ptr<Bells> bells = naps.begin_look();
      const bool came = look(bells.get());
      if (given_up_) break;
      look_for_stalls();
      settle_faults();
      settle_end();
      if (!all_clear_) naps.take(came, port_.is_sending() || port_.is_receiving());
    }
    given_up_ ? port_.abandon() : port_.finish();
    queue.end();
  }

  /// Sends queued messages and takes messages that have arrived. Returns whether any have arrived.
  bool look(Bells* bells) {
    try {
      post(bells);
      port_.complete();
      // Rings again for messages that MPI has not sent completely: it may have delayed them until this call.
      if (bells != nullptr) port_.for_each_receiver([&](int to) { bells->ring(to); });
      const bool came = port_.take();
      return deliver() || came;
    } catch (const scene::Error& error) {
      fail(error);
      give_up(error);  // MPI itself is broken: no message will reach any rank
      return false;
    }
  }

  /// Passes queued messages to MPI.
  void post(Bells* bells) {
    queue.hand_over([&](SendQueue::Outgoing& message) {
      if (mailboxes.failed() && message.tag != own_tag) return;
      const scene::TraceScope timing = queue.traced(message);
      port_.send(message.to, message.tag, std::move(message.bytes));
      if (bells != nullptr) bells->ring(message.to);
    });
  }

  /// Delivers the messages that have arrived.
  bool deliver() {
    bool moved = false;
    for (; auto arrived = port_.next(); moved = true) {
      Message& message = arrived->message;
      if (arrived->tag == own_tag) {
        obey(std::move(message));
        continue;
      }
      liveness.heard(message.from);
      if (!mailboxes.failed()) mailboxes.deliver(static_cast<Channel>(arrived->tag), std::move(message));
    }
    return moved;
  }

  /// Handles one of the transport's own messages. A message that no rank of this program sends is an error of the run.
  void obey(Message message) {
    try {
      MessageReader reader(message.bytes, message.from);
      const MessageKind kind = reader.kind();
      if (kind == MessageKind::alive || kind == MessageKind::silent) return liveness.take(std::move(message));
      liveness.heard(message.from);
      if (kind == MessageKind::fault)
        decide(take_error(reader));
      else if (kind == MessageKind::verdict)
        conclude(take_error(reader));
      else if (kind == MessageKind::done)
        ++ranks_done_;
      else if (kind == MessageKind::clear)
        all_clear_ = true;
      else
        reader.refuse_kind();
    } catch (const scene::Error& error) {
      fail(error);
    }
  }

  /// Sends to all ranks except rank 0 and this one.
  void tell_all(const Bytes& message) {
    for (int other = 1; other < size; ++other)
      if (other != rank) enqueue({other, own_tag, message});
  }

  /// Called on rank 0: the first error that it receives becomes the run's error.
  void decide(const scene::Error& error) {
    if (mailboxes.failed()) return;
    tell_all(error_message(MessageKind::verdict, error));
    conclude(error);
  }

  void conclude(const scene::Error& error) {
    if (!mailboxes.failed() && hooks_.on_fault) hooks_.on_fault();
    mailboxes.fail(error);
    if (!deadline_) deadline_ = Clock::now() + patience_;
  }

  void look_for_stalls() {
    try {
      for (auto& message : liveness.turn(rank, size)) enqueue({message.to, own_tag, std::move(message.bytes)});
    } catch (const scene::Error& error) {
      fail(error);
    }
    const scene::Error* const lost = liveness.lost();
    if (lost == nullptr || mailboxes.failed()) return;
    lost_at_ = Clock::now();
    if (rank == 0) return decide(*lost);
    // Rank 0 itself is lost: this rank decides instead.
    tell_all(error_message(MessageKind::verdict, *lost));
    conclude(*lost);
  }

  void settle_faults() {
    if (!asked_to_end_ && hooks_.asked_to_end)
      if ((asked_to_end_ = hooks_.asked_to_end(rank, size))) fail(*asked_to_end_);
    std::optional<scene::Error> fault;
    {
      const std::lock_guard lock(mutex_);
      if (own_fault_ && !fault_told_) {
        fault = own_fault_;
        fault_told_ = true;
      }
    }
    if (fault && rank == 0) decide(*fault);
    if (fault && rank != 0) {
      enqueue({0, own_tag, error_message(MessageKind::fault, *fault)});
      deadline_ = Clock::now() + patience_;
    }
    // Rank 0 gives up first; the other ranks give up only if rank 0 cannot.
    if (deadline_ && Clock::now() > *deadline_ + (rank == 0 ? std::chrono::seconds(0) : std::chrono::seconds(4)))
      give_up(mailboxes.failed() ? *mailboxes.error() : *own_fault_);
  }

  /// Called when an orderly end is impossible. Ends the process or, with a caller's communicator, only this rank's part
  /// in the run.
  void give_up(const scene::Error& error) {
    if (borrowed_) {
      mailboxes.fail(error);
      given_up_ = all_clear_ = true;
      return;
    }
    if (hooks_.speak) hooks_.speak(error);
    std::_Exit(static_cast<int>(error.code()));
  }

  /// Sends `done` once all messages of this rank have been sent; rank 0 answers with `clear`.
  void settle_end() {
    {
      const std::lock_guard lock(mutex_);
      if (!finishing_) return;
      // A stalled rank receives nothing and never sends `done`, and MPI cannot end without this rank. Once the other
      // ranks have had time to receive the error, this rank reports the error and leaves the rest to the launcher.
      if (lost_at_ && ((rank == 0 && ranks_done_ >= size - 2) || Clock::now() > *lost_at_ + stall_grace))
        give_up(*mailboxes.error());
      if (given_up_) return;
      if (!queue.is_empty() || port_.is_sending() || (own_fault_ && !mailboxes.failed())) return;
    }
    if (!done_told_) {
      done_told_ = true;
      if (rank == 0)
        ++ranks_done_;
      else
        enqueue({0, own_tag, begin_message(MessageKind::done)});
    }
    if (rank == 0 && ranks_done_ == size) {
      if (mailboxes.failed() && hooks_.speak) hooks_.speak(*mailboxes.error());
      tell_all(begin_message(MessageKind::clear));
      post(nullptr);
      all_clear_ = true;
    }
  }

  Hooks hooks_;
  std::chrono::milliseconds patience_;
  const bool borrowed_;
  std::promise<std::optional<scene::Error>> start_error_;

  std::mutex mutex_;  // guards the next two lines
  std::optional<scene::Error> own_fault_;
  bool finishing_ = false, fault_told_ = false;

  // Used only by the engine's thread.
  MpiPort port_;
  std::optional<Clock::time_point> lost_at_;  ///< when this rank ended the run because of another's silence
  std::optional<scene::Error> asked_to_end_;
  std::optional<Clock::time_point> deadline_;
  int ranks_done_ = 0;
  bool done_told_ = false, all_clear_ = false, given_up_ = false;

  std::thread thread_;  // last, because it uses all of the above
};

MpiTransport::MpiTransport(Hooks hooks, std::chrono::milliseconds patience)
    : engine_(std::make_unique<Engine>(std::move(hooks), patience, std::nullopt)) {}

MpiTransport::MpiTransport(int fortran_handle, std::chrono::milliseconds patience)
    : engine_(std::make_unique<Engine>(Hooks{}, patience, fortran_handle)) {}

MpiTransport::~MpiTransport() = default;

std::optional<scene::Error> MpiTransport::finish() { return engine_->finish(); }
int MpiTransport::rank() const { return engine_->rank; }
int MpiTransport::size() const { return engine_->size; }
void MpiTransport::send(int to, Channel channel, Bytes bytes, std::int32_t frame) {
  engine_->send(to, channel, std::move(bytes), frame);
}
std::optional<Message> MpiTransport::receive(Channel channel, std::chrono::milliseconds timeout) {
  return engine_->mailboxes.receive(channel, timeout);
}
void MpiTransport::fail(const scene::Error& error) { engine_->fail(error); }
void MpiTransport::set_working(bool working) { engine_->naps.set_working(working, engine_->rank); }
void MpiTransport::use_bells(const std::shared_ptr<Bells>& bells) { engine_->naps.use_bells(bells, engine_->rank); }
void MpiTransport::watch_stalls(const StallSettings& settings) { engine_->liveness.watch(settings); }
void MpiTransport::check() const { engine_->mailboxes.check(); }
void MpiTransport::trace_to(scene::Trace* projecting, scene::Trace* compositing) {
  engine_->queue.trace_to(projecting, compositing);
}
Transport::Traffic MpiTransport::sent(Channel channel) const { return engine_->sent.of(channel); }

}  // namespace tessera::exchange
