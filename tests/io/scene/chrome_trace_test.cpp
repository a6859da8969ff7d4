// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/chrome_trace.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using nlohmann::json;
using scene::TraceRole;

/// The only event with this phase and name.
json event(const json& events, const std::string& phase, const std::string& name) {
  json found;
  for (const auto& candidate : events)
    if (candidate.at("ph") == phase && candidate.at("name") == name) {
      EXPECT_TRUE(found.is_null()) << name << " stands twice";
      found = candidate;
    }
  EXPECT_FALSE(found.is_null()) << name;
  return found;
}

TEST(ChromeTrace, HoldsOneCompleteEventPerSpanWithAllItsData) {
  scene::Trace trace;
  trace.add({"project", 0, 10.5, 20, 19});
  trace.add({"send", 3, 31, 2.25, 2, 6, 5'000'000'000, 12, TraceRole::projector, 41, 2});
  const auto events = json::parse(chrome_trace_events(trace, 7, "rank 7 \"projector\"", 100));
  for (const auto& e : events) EXPECT_EQ(e.at("pid"), 7);
  EXPECT_EQ(event(events, "M", "process_name").at("args").at("name"), "rank 7 \"projector\"");
  const auto project = event(events, "X", "project");
  EXPECT_EQ(project.at("cat"), "tessera");
  EXPECT_EQ(project.at("ts"), 110.5);
  EXPECT_EQ(project.at("args"), (json{{"cpu_us", 19}}));
  const auto send = event(events, "X", "send");
  EXPECT_EQ(send.at("tid"), 3);
  EXPECT_EQ(send.at("ts"), 131);
  EXPECT_EQ(send.at("dur"), 2.25);
  EXPECT_EQ(send.at("args"), (json{{"cpu_us", 2},
                                   {"role", "projector"},
                                   {"frame", 6},
                                   {"bytes", 5'000'000'000},
                                   {"messages", 12},
                                   {"tile", 41},
                                   {"peer", 2}}));
}

TEST(ChromeTrace, ThreadsWithASingleRoleAreNamedByIt) {
  scene::Trace trace;
  trace.add({"project", 0, 0, 1, 1, 0, 0, 0, TraceRole::projector});
  trace.add({"composite", 1, 0, 1, 1, 0, 0, 0, TraceRole::projector});
  trace.add({"composite", 1, 1, 1, 1, 0, 0, 0, TraceRole::compositor});
  trace.add({"receive", 2, 1, 1, 1, 0, 0, 0, TraceRole::compositor});
  std::map<int, std::string> names;
  for (const auto& e : json::parse(chrome_trace_events(trace, 0, "rank 0")))
    if (e.at("name") == "thread_name") names[e.at("tid")] = e.at("args").at("name");
  EXPECT_EQ(names,
            (std::map<int, std::string>{{0, "projector thread 0"}, {1, "thread 1"}, {2, "compositor thread 2"}}));
}

TEST(ChromeTrace, OverlappingFramesHaveSeparateTracks) {
  scene::Trace trace;
  for (int frame = 0; frame < 4; ++frame)
    trace.add({"frame", 0, 100.0 * frame, 150, 0, frame, 0, 0, TraceRole::compositor});
  trace.add({"frame", 0, 0, 90, 0, 0, 0, 0, TraceRole::projector});
  std::map<int, std::vector<std::array<double, 2>>> tracks;
  for (const auto& e : json::parse(chrome_trace_events(trace, 0, "rank 0")))
    if (e.at("name") == "frame") tracks[e.at("tid")].push_back({e.at("ts"), e.at("dur")});
  EXPECT_EQ(tracks.size(), 3u);  // two of the compositor, one of the projector
  for (const auto& [track, spans] : tracks) {
    EXPECT_NE(track, 0);  // no thread's
    for (std::size_t i = 1; i < spans.size(); ++i) EXPECT_LE(spans[i - 1][0] + spans[i - 1][1], spans[i][0]);
  }
}

TEST(ChromeTrace, OneFileHoldsAllRanksAndWhatWasRun) {
  scene::Trace a, b;
  a.add({"read", 0, 0, 1, 1});
  b.add({"read", 0, 0, 1, 1});
  const std::array<std::string, 4> events = {chrome_trace_events(a, 0, "rank 0"), "", "[]",
                                             chrome_trace_events(b, 3, "rank 3 compositor")};
  const test::TemporaryFolder folder;
  TraceRun run{"1.2.3", "wake.vtu", 516096, 8,        640,     480,        4,           3,
               1,       2,          "runs", "planes", "exact", "0123abcd", "GNU 12.2.0"};
  run.parts = 1000000, run.parts_in_double_precision = 20;
  write_chrome_trace(events, run, folder / "trace.json");
  const auto root = json::parse(test::contents(folder / "trace.json"));
  std::set<int> ranks;
  for (const auto& e : root.at("traceEvents")) ranks.insert(e.at("pid").get<int>());
  EXPECT_EQ(ranks, (std::set<int>{0, 3}));
  const json expected = {{"program", "tessera"},
                         {"version", "1.2.3"},
                         {"commit", "0123abcd"},
                         {"build", "GNU 12.2.0"},
                         {"input", "wake.vtu"},
                         {"tets", 516096},
                         {"frames", 8},
                         {"width", 640},
                         {"height", 480},
                         {"ranks", 4},
                         {"projectors", 3},
                         {"compositors", 1},
                         {"threads_per_rank", 2},
                         {"parts", 1000000},
                         {"parts_in_double_precision", 20},
                         {"exchange", "runs"},
                         {"rasterizer", "planes"},
                         {"integrator", "exact"}};
  EXPECT_EQ(root.at("otherData"), expected);
}

TEST(ChromeTrace, AnEmptyTraceAndAForeignNameAreStillJson) {
  const test::TemporaryFolder folder;
  const std::array<std::string, 1> events = {chrome_trace_events(scene::Trace(), 0, "\xff\n")};
  write_chrome_trace(events, {}, folder / "trace.json");
  const auto root = json::parse(test::contents(folder / "trace.json"));
  event(root.at("traceEvents"), "M", "process_name");
}

TEST(ChromeTrace, RefusesAMissingDirectory) {
  const test::TemporaryFolder folder;
  test::expect_bad_input([&] { write_chrome_trace({}, {}, folder / "none/trace.json"); }, {"none/trace.json"});
}

}  // namespace
}  // namespace tessera::io
