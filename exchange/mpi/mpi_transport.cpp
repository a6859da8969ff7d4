// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/mpi/mpi_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "exchange/bells.hpp"
#include "exchange/heartbeats.hpp"
#include "exchange/mailboxes.hpp"
#include "exchange/message.hpp"
#include "exchange/mpi/mpi_port.hpp"
#include "exchange/run_faults.hpp"
#include "scene/start_thread.hpp"

namespace tessera::exchange {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

// Tags below channel_count are channels; this one is of the transport's own messages.
constexpr int own_tag = 100;  // of the kinds fault to silent (message.hpp)

// Naps of the engine between two looks at MPI: a look costs 20 to 30 us of a core that projects or composites. They
// double while nothing comes; messages on their way need looks to get on.
struct Naps {
  microseconds shortest, longest_moving, longest;
};
constexpr Naps idle_naps{microseconds(100), microseconds(500), microseconds(2000)};
// While the rank's cores project, a look in time for the next part of the frame is soon enough.
constexpr Naps working_naps{microseconds(2000), microseconds(2000), microseconds(5000)};

// Where others ring when they send.
constexpr microseconds longest_nap_with_bells(20'000);

/// For the others to hear of the error that a stalled rank is; at most the transport's patience.
constexpr auto stall_grace = std::chrono::seconds(1);
}  // namespace

/// The thread that speaks MPI, and what it shares with the others.
class MpiTransport::Engine {
 public:
  /// `borrowed`: a caller's communicator; else the world's, and all of MPI.
  Engine(Hooks hooks, std::chrono::milliseconds patience, std::optional<int> borrowed)
      : hooks_(std::move(hooks)),
        patience_(patience),
        borrowed_(borrowed.has_value()),
        port_(borrowed),
        thread_(scene::start_thread([this] { run(); })) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return started_; });
    if (start_error_) {
      lock.unlock();
      thread_.join();
      throw scene::Error(*start_error_);
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
    wake();
  }

  std::optional<scene::Error> finish() {
    {
      const std::lock_guard lock(mutex_);
      finishing_ = true;
    }
    wake();
    if (thread_.joinable()) thread_.join();
    return mailboxes.error();
  }

  void set_working(bool working) {
    working_ = working;
    if (!working) wake();
  }

  void use_bells(const std::shared_ptr<Bells>& bells) {
    {
      const std::lock_guard lock(mutex_);
      bells_ = bells;
    }
    changed_.notify_all();
  }

  void watch_stalls(const StallSettings& settings) {
    const std::lock_guard lock(mutex_);
    stalls_ = settings;
  }

  /// What was sent before is on the old faces when this returns.
  void trace_to(scene::Trace* projecting, scene::Trace* compositing) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return (queue_.empty() && !posting_) || ended_; });
    projecting_ = projecting;
    compositing_ = compositing;
  }

  int rank = 0, size = 1;
  Mailboxes mailboxes;
  TrafficCounters sent;

 private:
  struct Outgoing {
    int to, tag;
    Bytes bytes;
    std::int32_t frame = -1;
  };

  void enqueue(Outgoing message) {
    {
      const std::lock_guard lock(mutex_);
      queue_.push_back(std::move(message));
    }
    wake();
  }

  /// The engine's thread, from its nap.
  void wake() {
    changed_.notify_all();
    std::shared_ptr<Bells> bells;
    {
      const std::lock_guard lock(mutex_);
      bells = bells_;
    }
    if (bells != nullptr) bells->ring(rank);
  }

  /// Until there is something to do, for `most` at the longest. Returns whether a bell rang.
  bool nap(Bells* bells, std::uint32_t heard, microseconds most) {
    std::unique_lock lock(mutex_);
    if (!queue_.empty()) return false;
    if (bells == nullptr) {
      changed_.wait_for(lock, most);
      return false;
    }
    lock.unlock();
    bells->wait(heard, most);
    return bells->heard() != heard;
  }

  void run() {
    try {
      port_.start();
      rank = port_.rank();
      size = port_.size();
    } catch (const scene::Error& error) {
      start_error_ = error;
    }
    {
      const std::lock_guard lock(mutex_);
      started_ = true;
    }
    changed_.notify_all();
    if (start_error_) return;

    microseconds length = idle_naps.shortest;
    bool woken = false;
    while (!all_clear_) {
      bool came = false;
      const std::shared_ptr<Bells> bells = [&] {
        const std::lock_guard lock(mutex_);
        return bells_;
      }();
      const std::uint32_t heard = bells != nullptr ? bells->heard() : 0;
      try {
        post(bells.get());
        port_.complete();
        // MPI may have held a message back until now.
        if (bells != nullptr) port_.for_each_receiver([&](int to) { bells->ring(to); });
        came = port_.take();
        came = deliver() || came;
      } catch (const scene::Error& error) {
        fail(error);
        give_up(error);  // MPI itself is broken: no words will reach anyone
      }
      if (given_up_) break;
      look_for_stalls();
      settle_faults();
      settle_end();
      if (all_clear_) break;
      const bool moving = port_.is_sending() || port_.is_receiving();
      // Rung for while its cores project, a rank would look too often.
      Bells* const listens_to = working_ ? nullptr : bells.get();
      Naps naps = working_ ? working_naps : idle_naps;
      if (listens_to != nullptr && bells->of_all() && !moving) naps.longest = longest_nap_with_bells;
      // The bell may ring a little before MPI shows the message.
      const bool soon = came || woken;
      length =
          soon ? naps.shortest : std::clamp(2 * length, naps.shortest, moving ? naps.longest_moving : naps.longest);
      woken = nap(listens_to, heard, length);
    }
    given_up_ ? port_.abandon() : port_.finish();
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;  // what is queued stays there
    }
    changed_.notify_all();
  }

  /// Hands queued messages to MPI.
  void post(Bells* bells) {
    std::deque<Outgoing> queue;
    {
      const std::lock_guard lock(mutex_);
      queue.swap(queue_);
      posting_ = !queue.empty();
    }
    for (Outgoing& message : queue) {
      const bool is_ours = message.tag == own_tag;
      if (mailboxes.failed() && !is_ours) continue;
      const scene::TraceScope timing = traced(message);
      port_.send(message.to, message.tag, std::move(message.bytes));
      if (bells != nullptr) bells->ring(message.to);
    }
    if (queue.empty()) return;
    {
      const std::lock_guard lock(mutex_);
      posting_ = false;
    }
    changed_.notify_all();
  }

  /// A span of what a user asks about: fragments, meshes and tiles.
  scene::TraceScope traced(const Outgoing& message) {
    scene::Trace* trace = nullptr;
    if (message.tag == static_cast<int>(Channel::fragments) || message.tag == static_cast<int>(Channel::mesh))
      trace = projecting_;
    if (message.tag == static_cast<int>(Channel::tiles)) trace = compositing_;
    return {trace, "send", message.frame, message.bytes.size(), 1, message.to};
  }

  /// Hands on what has arrived.
  bool deliver() {
    bool moved = false;
    for (; auto arrived = port_.next(); moved = true) {
      Message& message = arrived->message;
      if (arrived->tag == own_tag) {
        obey(std::move(message));
        continue;
      }
      if (heartbeats_) heartbeats_->heard(message.from);
      if (!mailboxes.failed()) mailboxes.deliver(static_cast<Channel>(arrived->tag), std::move(message));
    }
    return moved;
  }

  /// Takes one of the transport's own messages. One that no rank of this program sends is an error of the run.
  void obey(Message message) {
    try {
      MessageReader reader(message.bytes, message.from);
      const MessageKind kind = reader.kind();
      if (kind == MessageKind::alive || kind == MessageKind::silent) {
        if (heartbeats_)
          heartbeats_->take(message.from, message.bytes);
        else
          early_beats_.push_back(std::move(message));  // of ranks that watch already
        return;
      }
      if (heartbeats_) heartbeats_->heard(message.from);
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

  /// To all ranks but rank 0 and this one.
  void tell_all(const Bytes& message) {
    for (int other = 1; other < size; ++other)
      if (other != rank) enqueue({other, own_tag, message});
  }

  /// Rank 0: the first error it hears of is the run's.
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
    {
      const std::lock_guard lock(mutex_);
      if (stalls_ && size > 1) heartbeats_.emplace(rank, size, *stalls_, process_name(), Clock::now());
      stalls_.reset();
    }
    if (heartbeats_)
      for (Message& beat : std::exchange(early_beats_, {})) obey(std::move(beat));
    if (!heartbeats_) return;
    for (auto& message : heartbeats_->turn(Clock::now())) enqueue({message.to, own_tag, std::move(message.bytes)});
    if (!heartbeats_->lost() || mailboxes.failed()) return;
    lost_at_ = Clock::now();
    if (rank == 0) return decide(heartbeats_->lost()->error);
    // Rank 0 itself: this rank decides in its place.
    tell_all(error_message(MessageKind::verdict, heartbeats_->lost()->error));
    conclude(heartbeats_->lost()->error);
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
    // Rank 0 first: the others only if it cannot.
    if (deadline_ && Clock::now() > *deadline_ + (rank == 0 ? std::chrono::seconds(0) : std::chrono::seconds(4)))
      give_up(mailboxes.failed() ? *mailboxes.error() : *own_fault_);
  }

  /// Ends what cannot end in order: the process, or where that is a caller's, this rank's part in the run.
  void give_up(const scene::Error& error) {
    if (borrowed_) {
      mailboxes.fail(error);
      given_up_ = all_clear_ = true;
      return;
    }
    if (hooks_.speak) hooks_.speak(error);
    std::_Exit(static_cast<int>(error.code()));
  }

  /// Done is said once, when all this rank has sent has left; rank 0 gives the all-clear.
  void settle_end() {
    {
      const std::lock_guard lock(mutex_);
      if (!finishing_) return;
      // A stalled rank takes nothing and will not say that it is done, and MPI cannot end without it: once the others
      // have had the time to hear of the error, this rank speaks and leaves the rest to the launcher.
      if (lost_at_ && ((rank == 0 && ranks_done_ >= size - 2) || Clock::now() > *lost_at_ + stall_grace))
        give_up(*mailboxes.error());
      if (given_up_) return;
      if (!queue_.empty() || port_.is_sending() || (own_fault_ && !mailboxes.failed())) return;
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

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  bool posting_ = false;                                         // messages are between the queue and MPI
  scene::Trace *projecting_ = nullptr, *compositing_ = nullptr;  // changed while nothing is being posted
  std::deque<Outgoing> queue_;
  std::optional<scene::Error> own_fault_, start_error_;
  std::optional<StallSettings> stalls_;  ///< until the engine has begun to watch
  bool started_ = false, ended_ = false, finishing_ = false, fault_told_ = false;
  std::atomic<bool> working_ = false;
  std::shared_ptr<Bells> bells_;

  // The engine's thread alone.
  MpiPort port_;
  std::optional<Heartbeats> heartbeats_;
  std::vector<Message> early_beats_;
  std::optional<Clock::time_point> lost_at_;  ///< when this rank ended the run for another's silence
  std::optional<scene::Error> asked_to_end_;
  std::optional<Clock::time_point> deadline_;
  int ranks_done_ = 0;
  bool done_told_ = false, all_clear_ = false, given_up_ = false;

  std::thread thread_;  // last: it uses all of the above
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
void MpiTransport::set_working(bool working) { engine_->set_working(working); }
void MpiTransport::use_bells(const std::shared_ptr<Bells>& bells) { engine_->use_bells(bells); }
void MpiTransport::watch_stalls(const StallSettings& settings) { engine_->watch_stalls(settings); }
void MpiTransport::check() const { engine_->mailboxes.check(); }
void MpiTransport::trace_to(scene::Trace* projecting, scene::Trace* compositing) {
  engine_->trace_to(projecting, compositing);
}
Transport::Traffic MpiTransport::sent(Channel channel) const { return engine_->sent.of(channel); }

}  // namespace tessera::exchange
