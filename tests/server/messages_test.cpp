// SPDX-License-Identifier: BSD-3-Clause
#include "server/messages.hpp"

#include <gtest/gtest.h>

#include "server/frame_message.hpp"
#include "tessera/error.hpp"

namespace tessera::server {
namespace {

TEST(Messages, AreStatesAcknowledgementsAndPauses) {
  const Message state = parse_message(R"({"type":"state","number":7,"moving":true,"state":{"size":"8x8"}})");
  ASSERT_TRUE(std::holds_alternative<StateMessage>(state));
  EXPECT_EQ(std::get<StateMessage>(state).number, 7u);
  EXPECT_TRUE(std::get<StateMessage>(state).moving);
  EXPECT_EQ(std::get<StateMessage>(state).state["size"], "8x8");
  const Message ack = parse_message(R"({"type":"ack","frame":18446744073709551615})");
  EXPECT_EQ(std::get<AckMessage>(ack).frame, 18446744073709551615u);
  EXPECT_TRUE(std::holds_alternative<PauseMessage>(parse_message(R"({"type":"pause","more":[1]})")));
}

TEST(Messages, AreRefusedInOneSentenceWithTheReason) {
  for (const char* text :
       {"", "7", "[]", "{", "{}", R"({"type":1})", R"({"type":"stat"})", R"({"type":"ack"})",
        R"({"type":"ack","frame":-1})", R"({"type":"ack","frame":1.5})", R"({"type":"ack","frame":"1"})",
        R"({"type":"state","number":1})", R"({"type":"state","number":1,"state":[]})",
        R"({"type":"state","number":1,"moving":1,"state":{}})", R"({"type":"state","state":{}})",
        R"({"type":"pause","type":"ack"})", "{\"type\":\"pause\"}\n{}"}) {
    try {
      parse_message(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input) << text;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << text;
    }
  }
}

TEST(Messages, HaveALimitOfValues) {
  std::string text = R"({"type":"pause","a":[0)";
  for (int i = 1; i < 99'997; ++i) text += ",0";
  EXPECT_NO_THROW(parse_message(text + "]}"));
  EXPECT_THROW(parse_message(text + ",0]}"), Error);
}

TEST(Messages, HaveNumbersWithinTheirLimits) {
  const Json body = parse_body(R"({"bins":16,"large":18446744073709551615,"small":-5,"half":0.5,"text":"1"})");
  EXPECT_EQ(whole_number(body, "bins", 1, 1, 100), 16);
  EXPECT_EQ(whole_number(body, "none", 9, 1, 100), 9);
  for (const char* name : {"large", "small", "half", "text"})
    EXPECT_THROW(whole_number(body, name, 1, 0, 100), Error) << name;
}

TEST(Messages, OfFramesBeginWithTheHeadersLength) {
  const std::string head = frame_head({{"frame", 1}});
  EXPECT_EQ(head, std::string("\x0b\0\0\0", 4) + R"({"frame":1})");
  EXPECT_EQ(frame_head({{"name", "a\xff"}}).substr(4), "{\"name\":\"a\xef\xbf\xbd\"}");  // U+FFFD
}

}  // namespace
}  // namespace tessera::server
