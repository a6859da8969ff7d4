// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/attempt.hpp"

#include <gtest/gtest.h>

#include "exchange/collectives.hpp"
#include "exchange/loopback_transport.hpp"

namespace tessera::exchange {
namespace {

TEST(Attempt, ThrowsOneRanksErrorOnAllAndLeavesNothingBehind) {
  for (const int ranks : {2, 3, 5})
    for (int faulty = 0; faulty < ranks; ++faulty)
      run_ranks(ranks, [&](Transport& beneath) {
        for (int round = 0; round < 3; ++round) {
          try {
            attempt(beneath, [&](Transport& transport) {
              barrier(transport);
              // Messages that are never received.
              for (int to = 0; to < ranks; ++to)
                transport.send(to, Channel::mesh, message_of(MessageKind::tet_count, std::uint64_t{7}));
              if (transport.rank() == faulty) throw scene::bad_input("mesh.vtu: is empty; give another");
              gather_values(transport, MessageKind::seconds, 1.0);
              transport.receive(Channel::tiles);
            });
            ADD_FAILURE() << "no error came out";
          } catch (const scene::Error& error) {
            EXPECT_STREQ(error.what(), "mesh.vtu: is empty; give another");
          }
          EXPECT_EQ(broadcast_value(beneath, round % ranks, MessageKind::seconds, 1.0 * beneath.rank()), round % ranks);
          beneath.send(beneath.rank(), Channel::mesh, message_of(MessageKind::tet_count, std::uint64_t{8}));
          EXPECT_EQ(
              value_of<std::uint64_t>(beneath.receive(Channel::mesh).bytes, beneath.rank(), MessageKind::tet_count),
              8u);
        }
      });
}

TEST(Attempt, SucceedsWhereAllDo) {
  run_ranks(3, [](Transport& beneath) {
    double sum = 0;
    attempt(beneath, [&](Transport& transport) {
      for (const double value : gather_values(transport, MessageKind::seconds, 1.0 + transport.rank())) sum += value;
    });
    EXPECT_EQ(sum, 6);
    barrier(beneath);
  });
}

TEST(Attempt, FailsOnAllRanksAfterOneHasFinished) {
  run_ranks(2, [](Transport& beneath) {
    EXPECT_THROW(attempt(beneath,
                         [](Transport& transport) {
                           if (transport.rank() == 1) transport.fail(scene::bad_input("a: b; c"));
                         }),
                 scene::Error);
    barrier(beneath);
  });
}

TEST(Attempt, KeepsTheRunsOwnError) {
  EXPECT_THROW(run_ranks(2,
                         [](Transport& beneath) {
                           attempt(beneath, [&](Transport& transport) {
                             if (transport.rank() == 1) beneath.fail(scene::bad_input("rank 1: is lost; run again"));
                             transport.receive(Channel::tiles);
                           });
                           ADD_FAILURE() << "the run has ended";
                         }),
               scene::Error);
}

}  // namespace
}  // namespace tessera::exchange
