// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/chrome_trace_reader.hpp"

#include <gtest/gtest.h>

#include <array>

#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using scene::TraceRole;
using test::expect_bad_input;

const std::string good =
    R"({"name":"sort","cat":"tessera","ph":"X","pid":1,"tid":2,"ts":3.5,"dur":4,"args":{"cpu_us":1}})";

TEST(ChromeTraceReader, ReadsBackWhatWasWritten) {
  scene::Trace first, second;
  first.add({"read", 0, 1.5, 20, 19, -1, 123'456'789'012, 0});
  first.add({"send", 3, 31, 2.25, 2, 6, 99, 12, TraceRole::projector, 41, 0});
  second.add({"frame", 0, 0, 50, 0, 6, 0, 0, TraceRole::compositor});
  const std::array<std::string, 2> events = {chrome_trace_events(first, 0, "rank 0", 0),
                                             chrome_trace_events(second, 1, "rank 1", -1000)};
  TraceRun run{"1.2.3", "wake.vtu", 516096, 8,        640,     480,        2,           1,
               1,       2,          "runs", "planes", "exact", "0123abcd", "GNU 12.2.0"};
  run.parts = 3000000000, run.parts_in_double_precision = 7;
  const test::TemporaryFolder folder;
  write_chrome_trace(events, run, folder / "trace.json");
  const TraceFile file = read_chrome_trace(folder / "trace.json");
  EXPECT_EQ(file.run, run);
  ASSERT_EQ(file.spans.size(), 3u);
  EXPECT_EQ(file.stages, (std::vector<std::string>{"read", "send", "frame"}));
  EXPECT_EQ(file.spans[0].start_us, 1.5);
  EXPECT_EQ(file.spans[0].wall_us, 20);
  EXPECT_EQ(file.spans[0].cpu_us, 19);
  EXPECT_EQ(file.spans[0].frame, -1);
  EXPECT_EQ(file.spans[0].tile, -1);
  EXPECT_EQ(file.spans[0].peer, -1);
  EXPECT_EQ(file.spans[0].bytes, 123'456'789'012u);
  EXPECT_EQ(file.spans[0].role, TraceRole::both);
  EXPECT_EQ(file.spans[1].thread, 3u);
  EXPECT_EQ(file.spans[1].frame, 6);
  EXPECT_EQ(file.spans[1].messages, 12u);
  EXPECT_EQ(file.spans[1].role, TraceRole::projector);
  EXPECT_EQ(file.spans[1].tile, 41);
  EXPECT_EQ(file.spans[1].peer, 0);
  EXPECT_EQ(file.spans[2].rank, 1);
  EXPECT_EQ(file.spans[2].start_us, -1000);
  EXPECT_EQ(file.spans[2].role, TraceRole::compositor);
}

TEST(ChromeTraceReader, SkipsEventsOfOtherPrograms) {
  const auto file = parse_chrome_trace(
      R"({"stackFrames": {"1": {"cat": "tessera"}}, "traceEvents": [
        {"name": "v8", "cat": "chrome", "ph": "X"}, {"ph": "M", "cat": "tessera"}, 17, [], null,
        {"args": {"frame": 5, "more": {"frame": 7, "ts": 1}, "list": [{"dur": 8}]}, "ts": 1, "dur": 2, "id": "x",
         "ph": "X", "cat": "tessera", "pid": 0, "tid": 0, "name": "sort", "sub": {"ts": 9}},
        {"name": "cull", "cat": "tessera", "ph": "B", "ts": "?"}]})",
      "a.json");
  ASSERT_EQ(file.spans.size(), 1u);
  EXPECT_EQ(file.spans[0].frame, 5);
  EXPECT_EQ(file.spans[0].start_us, 1);
  EXPECT_EQ(file.spans[0].wall_us, 2);
  EXPECT_EQ(parse_chrome_trace("[" + good + "]", "a.json").spans.size(), 1u);
}

TEST(ChromeTraceReader, ACutFileIsRefusedWhereverItWasCut) {
  const std::string whole = R"({"otherData":{"tets":3},"traceEvents":[)" + good + "," + good + "]}";
  ASSERT_EQ(parse_chrome_trace(whole, "a.json").spans.size(), 2u);
  for (std::size_t size = 0; size < whole.size(); ++size)
    expect_bad_input([&] { parse_chrome_trace(whole.substr(0, size), "a.json"); },
                     {"a.json: line 1", "not valid JSON"});
}

TEST(ChromeTraceReader, ReportsATraceOfAnotherProgram) {
  for (const char* text : {R"({"traceEvents": [{"name": "v8", "cat": "chrome", "ph": "X", "ts": 1, "dur": 2}]})", "{}",
                           "[]", "17", R"({"position": [1, 2, 3]})"})
    expect_bad_input([&] { parse_chrome_trace(text, "a.json"); }, {"a.json: it has no spans recorded by Tessera"});
}

TEST(ChromeTraceReader, ReportsInvalidEventsByTheirNumber) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string event = good;
    event.replace(event.find(from), from.size(), to);
    return "[" + good + "," + event + "]";
  };
  const std::vector<std::array<std::string, 3>> cases = {
      {R"("ts":3.5,)", "", "ts is missing"},
      {R"("dur":4)", R"("dur":"4")", "dur is missing or not a number"},
      {R"("dur":4)", R"("dur":-4)", "dur is -4"},
      {R"("ts":3.5)", R"("ts":1e300)", "ts is 1e+300"},
      {R"("pid":1,)", "", "pid is missing"},
      {R"("pid":1)", R"("pid":1.5)", "pid is 1.5"},
      {R"("tid":2)", R"("tid":-2)", "tid is -2"},
      {R"("cpu_us":1)", R"("cpu_us":-1)", "cpu_us is -1"},
      {R"("cpu_us":1)", R"("frame":0.5)", "frame is 0.5"},
      {R"("cpu_us":1)", R"("bytes":-1)", "bytes is -1"},
      {R"("cpu_us":1)", R"("messages":1e30)", "messages is 1e+30"},
      {R"("cpu_us":1)", R"("tile":-2)", "tile is -2"},
      {R"("cpu_us":1)", R"("peer":0.5)", "peer is 0.5"},
      {R"("cpu_us":1)", R"("role":"king")", "'king'"},
      {R"("name":"sort",)", "", "name is missing"},
  };
  for (const auto& [from, to, words] : cases)
    expect_bad_input([&, &from = from, &to = to] { parse_chrome_trace(with(from, to), "a.json"); },
                     {"a.json: event 2", words});
  expect_bad_input([&] { parse_chrome_trace(R"({"otherData":{"ranks":-1}})", "a.json"); }, {"a.json", "ranks is -1"});
  expect_bad_input([&] { parse_chrome_trace(R"({"otherData":{"tets":1e40}})", "a.json"); },
                   {"a.json", "tets is 1e+40"});
}

TEST(ChromeTraceReader, LimitsNestingAndStages) {
  const std::string deep(100'000, '[');
  expect_bad_input([&] { parse_chrome_trace(deep, "a.json"); }, {"not valid JSON"});
  std::string many = "[";
  for (int i = 0; i < 1001; ++i) {
    std::string event = good;
    many += event.replace(event.find("sort"), 4, "stage" + std::to_string(i)) + (i < 1000 ? "," : "]");
  }
  expect_bad_input([&] { parse_chrome_trace(many, "a.json"); }, {"kinds of stages"});
}

}  // namespace
}  // namespace tessera::io
