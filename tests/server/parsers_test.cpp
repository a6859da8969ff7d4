// SPDX-License-Identifier: BSD-3-Clause
// Whatever clients send, parsers accept it or report the error in one sentence.

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "server/access.hpp"
#include "server/messages.hpp"
#include "tessera/error.hpp"
#include "tessera/program/state_words.hpp"

namespace tessera::server {
namespace {

constexpr int trials = 100'000;

const std::vector<std::string> seeds = {
    R"({"type":"state","number":7,"moving":true,"state":{"size":"800x600","field":"v:mag","clip":["box:0,0,0,1,1,1"]}})",
    R"({"type":"state","number":1,"state":{"camera":{"position":[1,2,3],"focal_point":[0,0,0],"view_up":[0,0,1]}}})",
    R"({"type":"state","number":2,"state":{"transfer-function":{"knots":[[0,0,0,0,0],[1,1,1,1,2.5]]},"range":"0,1"}})",
    R"({"type":"state","number":3,"state":{"surface":["boundary:white:0.3"],"iso":["0.5:red:0.4"],"axes":"both"}})",
    R"({"type":"ack","frame":12})",
    R"({"type":"pause"})"};

std::string mutated(std::mt19937& random) {
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  std::string text = seeds[below(seeds.size())];
  for (std::size_t i = 0, changes = 1 + below(6); i < changes && !text.empty(); ++i) {
    const std::size_t at = below(text.size());
    switch (below(5)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.erase(at, 1 + below(8));
        break;
      case 2:
        text.insert(at, 1, "{}[]\",:0-.e\\"[below(12)]);
        break;
      case 3:
        text.insert(at, seeds[below(seeds.size())].substr(0, 1 + below(40)));
        break;
      default:
        text.resize(at);
        break;
    }
  }
  return text;
}

template <class Work>
bool is_taken(const Work& work, const std::string& text) {
  try {
    work();
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input) << text;
    EXPECT_LT(std::string(error.what()).size(), 1000u) << text;
    return false;
  }
}

TEST(ServerParsers, AcceptMutatedMessagesOrReportTheReason) {
  const std::uint32_t seed = std::random_device()();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  int messages = 0, states = 0;
  for (int i = 0; i < trials; ++i) {
    const std::string text = mutated(random);
    messages += is_taken(
        [&] {
          const Message message = parse_message(text);
          const auto* const state = std::get_if<StateMessage>(&message);
          if (state != nullptr)
            states += is_taken([&] { shell_words(arguments_of(state_words({}, state->state))); }, text);
        },
        text);
  }
  EXPECT_GT(messages, trials / 100);
  EXPECT_GT(states, trials / 1000);
  EXPECT_LT(messages, trials);
}

TEST(ServerParsers, AcceptMutatedHostsAndQueries) {
  std::mt19937 random(5);
  const std::vector<std::string> names = {"127.0.0.1:8080", "[::1]:80", "localhost", "token=12&state=%7B%7D",
                                          "a.b:443"};
  for (int i = 0; i < trials; ++i) {
    std::string text = names[random() % names.size()];
    text[random() % text.size()] = static_cast<char>(random() % 256);
    text.insert(random() % text.size(), 1, static_cast<char>(random() % 256));
    host_name(text);
    query_value(text, "state");
    decoded(text, true);
  }
}

}  // namespace
}  // namespace tessera::server
