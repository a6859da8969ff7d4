#include "io/chrome_trace.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "temporary_folder.hpp"

namespace tessera::io {
namespace {

TEST(ChromeTrace, HoldsOneCompleteEventASpanAndNamesProcessAndThreads) {
  scene::Trace trace;
  trace.add({"project", 0, 10.5, 20, 19});
  trace.add({"sort", 3, 31, 2.25, 2});
  const test::TemporaryFolder folder;
  write_chrome_trace(trace, folder / "trace.json", 7, "projector \"7\"");
  const auto root = nlohmann::json::parse(test::contents(folder / "trace.json"));
  const auto& events = root.at("traceEvents");
  ASSERT_EQ(events.size(), 5u);
  int names = 0, spans = 0;
  for (const auto& event : events) {
    EXPECT_EQ(event.at("pid"), 7);
    if (event.at("ph") == "M") {
      ++names;
      if (event.at("name") == "process_name") {
        EXPECT_EQ(event.at("args").at("name"), "projector \"7\"");
      }
    } else {
      ASSERT_EQ(event.at("ph"), "X");
      ++spans;
      if (event.at("name") == "sort") {
        EXPECT_EQ(event.at("tid"), 3);
        EXPECT_EQ(event.at("ts"), 31);
        EXPECT_EQ(event.at("dur"), 2.25);
        EXPECT_EQ(event.at("args").at("cpu_us"), 2);
      }
    }
  }
  EXPECT_EQ(names, 3);  // the process and two threads
  EXPECT_EQ(spans, 2);
}

TEST(ChromeTrace, AnEmptyTraceAndAForeignNameAreStillJson) {
  const scene::Trace trace;
  const auto root = nlohmann::json::parse(chrome_trace_json(trace, 0, "\xff\n"));
  EXPECT_EQ(root.at("traceEvents").size(), 1u);
}

TEST(ChromeTrace, RefusesAFolderThatIsNotThere) {
  const test::TemporaryFolder folder;
  test::expect_bad_input([&] { write_chrome_trace(scene::Trace(), folder / "none/trace.json", 0, "a"); }, {"none/trace.json"});
}

}  // namespace
}  // namespace tessera::io
