// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/state_words.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tessera/error.hpp"

namespace tessera {
namespace {

using Json = nlohmann::json;

OptionWords words_of(std::initializer_list<std::pair<const char*, std::vector<std::string>>> options) {
  OptionWords words;
  for (const auto& [name, values] : options) words.set(name, values);
  return words;
}

TEST(StateWords, AreTheOptionsOfRender) {
  const Json state = Json::parse(R"({"size":"8x6","smooth":true,"shade":false,"log":null,"opacity":2.5,
    "clip":["box:0,0,0,1,1,1","0,0,0,1,0,0"],"axes":"box","color-bar":true,"camera":{"position":[0,0,1]},
    "transfer-function":"viridis:rise"})");
  const std::vector<std::string> arguments = arguments_of(state_words({}, state));
  EXPECT_EQ(arguments,
            (std::vector<std::string>{"--axes=box", "--camera={\"position\":[0,0,1]}", "--clip=box:0,0,0,1,1,1",
                                      "--clip=0,0,0,1,0,0", "--color-bar", "--opacity=2.5", "--size=8x6", "--smooth",
                                      "--transfer-function=viridis:rise"}));
}

TEST(StateWords, OverrideThoseTheServerWasStartedWith) {
  const OptionWords base =
      words_of({{"field", {"p"}}, {"log", {"true"}}, {"view", {"front"}}, {"zoom", {"2"}}, {"threads", {"2"}}});
  EXPECT_EQ(arguments_of(state_words(base, Json::object())),
            (std::vector<std::string>{"--field=p", "--log", "--threads=2", "--view=front", "--zoom=2"}));
  // A camera replaces the options that place one; null removes an option.
  EXPECT_EQ(arguments_of(state_words(base, Json::parse(R"({"field":"v:mag","log":null,"camera":{}})"))),
            (std::vector<std::string>{"--camera={}", "--field=v:mag", "--threads=2"}));
  EXPECT_EQ(state_of_words(base), Json::parse(R"({"field":"p","log":true,"view":"front","zoom":"2"})"));
}

// Without `=`, an option with the text "true" would take the next word as its text.
TEST(StateWords, KeepTrueGivenAsTextAsText) {
  const Json state = Json::parse(R"({"annotate":["true"],"color-bar-title":"true","field":"true","surface":["true"],
    "transfer-function":"viridis","smooth":true,"scale-bar":true})");
  EXPECT_EQ(arguments_of(state_words({}, state)),
            (std::vector<std::string>{"--annotate=true", "--color-bar-title=true", "--field=true", "--scale-bar",
                                      "--smooth", "--surface=true", "--transfer-function=viridis"}));
  EXPECT_EQ(arguments_of(words_of({{"annotate", {"true"}}, {"half", {"true"}}})),
            (std::vector<std::string>{"--annotate=true", "--half"}));
}

TEST(StateWords, HaveTextsThatLookLikeFlags) {
  const Json state = Json::parse(R"({"annotate":["true"],"color-bar":true,"color-bar-title":"true","field":"true"})");
  EXPECT_EQ(arguments_of(state_words({}, state)),
            (std::vector<std::string>{"--annotate=true", "--color-bar", "--color-bar-title=true", "--field=true"}));
}

TEST(StateWords, NameFilesOfSurfacesThatTheServerWasStartedWith) {
  const OptionWords base = words_of({{"surface", {"a:b.stl:red", "boundary"}}});
  EXPECT_EQ(state_of_words(base), Json::parse(R"({"surface":["a:b.stl:red","boundary"]})"));
  const Json allowed = Json::parse(R"({"surface":["a:b.stl:blue:0.5"]})");
  EXPECT_EQ(arguments_of(state_words(base, allowed)), (std::vector<std::string>{"--surface=a:b.stl:blue:0.5"}));
  for (const char* text :
       {R"({"surface":["b.stl"]})", R"({"surface":["a:b.stl.stl"]})", R"({"surface":["a:b.stl:c.ply:red"]})"})
    EXPECT_THROW(state_words(base, Json::parse(text)), Error) << text;
}

TEST(StateWords, RefuseFilesAndOtherOptions) {
  for (const char* text : {R"({"camera":"view.json"})",
                           R"({"transfer-function":"/etc/passwd"})",
                           R"({"transfer-function":"map.json"})",
                           R"({"surface":["wing.stl"]})",
                           R"({"surface":"/etc/passwd:red:1"})",
                           R"({"output":"a.png"})",
                           R"({"report":"a"})",
                           R"({"config":"a"})",
                           R"({"q":"a"})",
                           R"({"threads":"64"})",
                           R"({"memory":"1T"})",
                           R"({"annotation-layer":"a.png"})",
                           R"({"size":{}})",
                           R"({"size":["8x8"]})",
                           R"({"size":""})",
                           R"({"smooth":"yes"})",
                           R"({"field":"a\nb"})",
                           R"({"clip":[1,[2]]})",
                           R"({"clip":[null]})",
                           R"({"orbit":"10"})",
                           R"({"--size":"8x8"})",
                           R"({"":"8x8"})"}) {
    try {
      state_words({}, Json::parse(text));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input) << text;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << text;
    }
  }
  // Blocks of the mesh and its boundary are not files.
  EXPECT_NO_THROW(state_words({}, Json::parse(R"({"surface":["boundary","boundary/walls:red:0.5","side set 1"]})")));
}

TEST(StateWords, AreQuotedForAShell) {
  EXPECT_EQ(shell_words({"tessera", "render", "my mesh.vtu", "--camera={\"a\":1}", "--annotate=it's", "-o", "p.png"}),
            "tessera render 'my mesh.vtu' --camera='{\"a\":1}' --annotate='it'\\''s' -o p.png");
}

}  // namespace
}  // namespace tessera
