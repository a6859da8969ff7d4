// SPDX-License-Identifier: BSD-3-Clause
// A caller that uses MPI itself: ranks 0 and 1 of three render a mesh from arrays on their own communicator, while rank
// 2 does something else and sends messages to rank 0. Exit status 0 on success.
//   mpirun -n 3 own_communicator            the above
//   mpirun -n 3 own_communicator funneled   MPI is started with too few threads: an error that reports it
#include <cstdio>
#include <cstring>
#include <stop_token>
#include <string>
#include <vector>

#include "cubes.hpp"
#include "tessera/mpi.hpp"
#include "tessera/tessera.hpp"

namespace {

int faults = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  ++faults;
  std::fprintf(stderr, "own_communicator: %s\n", what);
}

class StopAtFirstTile final : public tessera::Sink {
 public:
  void tile(const tessera::Tile& /*tile*/) override { source.request_stop(); }
  std::stop_source source;
};

void render(MPI_Comm two, int rank) {
  const tessera::Cubes mesh(12);
  const tessera::Dataset data = tessera::Dataset::of(mesh.arrays());
  const tessera::View view = data.default_view({160, 120});
  const tessera::TransferFunction function = data.transfer_function("viridis").function;
  const tessera::RenderedFrame alone = tessera::Session(data).render(view, function);

  tessera::Settings settings;
  settings.ranks.exchange = tessera::Exchange::segments;
  const tessera::Communicator ranks = tessera::communicator(two);
  expect(ranks.size() == 2 && ranks.rank() == rank, "the communicator has another shape");
  tessera::Session session(data, settings, ranks), other(data, settings, ranks);
  const auto whole = [&](tessera::Session& of, const char* what) {
    const tessera::RenderedFrame frame = of.render(view, function);
    expect(!frame.stopped, what);
    if (of.assembles()) expect(frame.image.rgba == alone.image.rgba && frame.image.depth == alone.image.depth, what);
  };
  whole(session, "the picture has other bits than one process's");
  whole(other, "a second session's picture has other bits");
  // Either rank requests a stop before the frame begins. Below, the sink requests a stop.
  for (int stopping_rank = 0; stopping_rank < 2; ++stopping_rank) {
    std::stop_source source;
    if (rank == stopping_rank) source.request_stop();
    expect(session.render(view, function, {}, nullptr, source.get_token()).stopped, "it was not stopped on all ranks");
    whole(session, "the picture after a stop has other bits");
  }
  // The image is so large that its tiles are sent in many messages.
  const tessera::View large = data.default_view({1600, 1200});
  StopAtFirstTile sink;
  expect(session.render(large, function, {}, &sink, sink.source.get_token()).stopped,
         "the sink's stop was not received");
  whole(session, "the picture after the sink's stop has other bits");
}

}  // namespace

int main(int argc, char** argv) {
  const bool funneled = argc > 1 && std::strcmp(argv[1], "funneled") == 0;
  int provided = 0, rank = 0, size = 0;
  MPI_Init_thread(&argc, &argv, funneled ? MPI_THREAD_FUNNELED : MPI_THREAD_MULTIPLE, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  expect(size == 3, "start me with mpirun -n 3");
  MPI_Comm two = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, rank < 2 ? 0 : MPI_UNDEFINED, rank, &two);
  constexpr int tag = 5, messages = 1000;
  if (rank == 2) {
    // Other work, with the caller's own messages, whose tags the library uses too.
    for (int i = 0; i < messages; ++i) MPI_Send(&i, 1, MPI_INT, 0, tag, MPI_COMM_WORLD);
  } else {
    try {
      render(two, rank);
      expect(!funneled, "MPI_THREAD_FUNNELED was taken for enough");
    } catch (const tessera::Error& error) {
      const std::string line = error.what();
      expect(funneled && line.find("MPI_THREAD_MULTIPLE") != std::string::npos, error.what());
    }
    MPI_Comm_free(&two);
  }
  if (rank == 0)
    for (int i = 0, got = -1; i < messages; ++i) {
      MPI_Recv(&got, 1, MPI_INT, 2, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      expect(got == i, "a message of the caller's own was lost");
    }
  int of_all = 0;
  MPI_Allreduce(&faults, &of_all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  MPI_Finalize();
  return of_all == 0 ? 0 : 1;
}
