// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/mpi/mpi_port.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <deque>
#include <iterator>
#include <list>
#include <string_view>
#include <utility>
#include <vector>

#include "exchange/mpi/mpi_transport.hpp"
#include "scene/error.hpp"

namespace tessera::exchange {
namespace {

void require_running() {
  int running = 0, ended = 0;
  MPI_Initialized(&running);
  MPI_Finalized(&ended);
  if (running == 0 || ended != 0)
    throw scene::bad_input("communicator: MPI is not running; call MPI_Init_thread first, MPI_Finalize last");
}

MPI_Comm duplicate(int fortran_handle) {
  require_running();
  int provided = MPI_THREAD_SINGLE;
  MPI_Query_thread(&provided);
  if (provided < MPI_THREAD_MULTIPLE)
    throw scene::bad_input(
        "communicator: MPI was started with too little thread support; call MPI_Init_thread with MPI_THREAD_MULTIPLE");
  MPI_Comm copy = MPI_COMM_NULL;
  if (MPI_Comm_dup(MPI_Comm_f2c(fortran_handle), &copy) != MPI_SUCCESS)
    throw scene::Error(scene::ErrorCode::system_failure, "communicator: MPI cannot duplicate it");
  return copy;
}

}  // namespace

bool launched_by_mpi() {
  // These are set by Open MPI's mpirun, PMIx launchers (srun, prun), and PMI-1/2 launchers, in this order.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

MpiShape mpi_shape(int fortran_handle) {
  require_running();
  MpiShape shape;
  MPI_Comm_rank(MPI_Comm_f2c(fortran_handle), &shape.rank);
  MPI_Comm_size(MPI_Comm_f2c(fortran_handle), &shape.size);
  return shape;
}

struct MpiPort::State {
  struct Outgoing {
    Bytes bytes;
    int to = 0;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  struct Incoming {
    Arrived arrived;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  void checked(int code, const char* doing) const {
    if (code == MPI_SUCCESS) return;
    char words[MPI_MAX_ERROR_STRING];
    int length = 0;
    MPI_Error_string(code, words, &length);
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("rank {} of {}: MPI cannot {}: {}", rank, size, doing,
                                   std::string_view(words, static_cast<std::size_t>(length))));
  }

  MPI_Comm comm;
  bool borrowed;
  int rank = 0, size = 1;
  std::list<Outgoing> outgoing;
  std::deque<Incoming> incoming;
};

MpiPort::MpiPort(std::optional<int> fortran_handle)
    : state_(std::make_unique<State>(State{
          fortran_handle ? duplicate(*fortran_handle) : MPI_COMM_WORLD, fortran_handle.has_value(), 0, 1, {}, {}})) {}
MpiPort::~MpiPort() = default;

void MpiPort::start() {
  int provided = MPI_THREAD_FUNNELED;
  State& s = *state_;
  if (!s.borrowed) s.checked(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "start");
  MPI_Comm_set_errhandler(s.comm, MPI_ERRORS_RETURN);
  s.checked(MPI_Comm_rank(s.comm, &s.rank), "get the rank");
  s.checked(MPI_Comm_size(s.comm, &s.size), "get the number of ranks");
  rank_ = s.rank;
  size_ = s.size;
  if (provided < MPI_THREAD_FUNNELED)
    throw scene::Error(scene::ErrorCode::system_failure,
                       "MPI: it does not support threads (MPI_THREAD_FUNNELED); use a build of MPI that does");
}

void MpiPort::send(int to, int tag, Bytes bytes) {
  State::Outgoing& posted = state_->outgoing.emplace_back();
  posted.bytes = std::move(bytes);
  posted.to = to;
  // complete() tests this request together with all others.
  // NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker)
  state_->checked(MPI_Isend(posted.bytes.data(), static_cast<int>(posted.bytes.size()), MPI_BYTE, to, tag, state_->comm,
                            &posted.request),
                  "send");
}

void MpiPort::complete() {
  auto& outgoing = state_->outgoing;
  for (auto message = outgoing.begin(); message != outgoing.end();) {
    int left = 0;
    state_->checked(MPI_Test(&message->request, &left, MPI_STATUS_IGNORE), "send");
    message = left == 0 ? std::next(message) : outgoing.erase(message);
  }
}

bool MpiPort::is_sending() const { return !state_->outgoing.empty(); }

bool MpiPort::take() {
  State& s = *state_;
  bool came = false;
  for (;;) {
    MPI_Message handle = MPI_MESSAGE_NULL;
    MPI_Status status;
    int found = 0, length = 0;
    s.checked(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, s.comm, &found, &handle, &status), "look for messages");
    if (found == 0) return came;
    came = true;
    s.checked(MPI_Get_count(&status, MPI_BYTE, &length), "receive");
    State::Incoming& begun = s.incoming.emplace_back();
    begun.arrived = {{status.MPI_SOURCE, Bytes(static_cast<std::size_t>(length))}, status.MPI_TAG};
    s.checked(MPI_Imrecv(begun.arrived.message.bytes.data(), length, MPI_BYTE, &handle, &begun.request), "receive");
  }
}

std::optional<MpiPort::Arrived> MpiPort::next() {
  // A complete message does not wait for an incomplete message of another rank, even if that message was announced
  // earlier. The messages of one rank stay in order.
  constexpr std::size_t most_looked_at = 64;
  State& s = *state_;
  std::vector<int> waited_for;
  const std::size_t count = std::min(s.incoming.size(), most_looked_at);
  for (std::size_t k = 0; k < count; ++k) {
    State::Incoming& message = s.incoming[k];
    const int from = message.arrived.message.from;
    if (std::find(waited_for.begin(), waited_for.end(), from) != waited_for.end()) continue;
    int here = 0;
    s.checked(MPI_Test(&message.request, &here, MPI_STATUS_IGNORE), "receive");
    if (here == 0) {
      waited_for.push_back(from);
      continue;
    }
    Arrived arrived = std::move(message.arrived);
    s.incoming.erase(s.incoming.begin() + static_cast<std::ptrdiff_t>(k));
    return arrived;
  }
  return std::nullopt;
}

void MpiPort::for_each_receiver(const std::function<void(int rank)>& visit) const {
  for (const State::Outgoing& message : state_->outgoing) visit(message.to);
}

bool MpiPort::is_receiving() const { return !state_->incoming.empty(); }

void MpiPort::finish() {
  while (is_sending()) complete();
  if (state_->borrowed)
    MPI_Comm_free(&state_->comm);
  else
    MPI_Finalize();
}

void MpiPort::abandon() { static_cast<void>(state_.release()); }

}  // namespace tessera::exchange
