// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/timing_breakdown.hpp"

#include <gtest/gtest.h>

#include "analysis/timing_clock.hpp"
#include "apps/program.hpp"
#include "apps/traced_pipeline.hpp"

namespace tessera::apps {
namespace {

/// Times in files are rounded to a nanosecond; a few hundred of them are summed.
constexpr double rounding_us = 1;

enum Stage : std::uint16_t { frame, wait, project, sort, integrate, stage_count };

FileSpan span(Stage stage, std::uint32_t thread, double start, double wall, double cpu = 0) {
  FileSpan made;
  made.stage = stage;
  made.thread = thread;
  made.start_us = start;
  made.wall_us = wall;
  made.cpu_us = cpu;
  return made;
}

analysis::ProcessTime share(const std::vector<FileSpan>& spans) {
  return analysis::share_clock(spans, stage_count, frame, wait);
}

analysis::RunTime run_of(const TracedPipeline& pipeline) {
  const Folder folder;
  pipeline.write(folder / "trace.json");
  return analysis::break_down(read_trace(folder / "trace.json"), "trace.json");
}

void expect_stage(const analysis::RoleTime& role, const std::string& name, double ms_a_frame, double cpu_ms_a_frame,
                  int frames) {
  const analysis::StageTime* stage = role.stage(name);
  ASSERT_NE(stage, nullptr) << name;
  EXPECT_NEAR(stage->average_us, ms_a_frame * 1e3 * frames, rounding_us) << name;
  EXPECT_NEAR(stage->cpu_us, cpu_ms_a_frame * 1e3 * frames, rounding_us) << name;
}

TEST(SharedClock, AnInnerSpanTakesItsTimeFromTheOuterOne) {
  const auto time = share(
      {span(frame, 0, 0, 100), span(project, 0, 10, 60, 50), span(integrate, 0, 20, 30, 25), span(sort, 0, 30, 10, 5)});
  EXPECT_EQ(time.in_frames[project].wall_us, 30);
  EXPECT_EQ(time.in_frames[integrate].wall_us, 20);
  EXPECT_EQ(time.in_frames[sort].wall_us, 10);
  EXPECT_EQ(time.other_us, 40);
  EXPECT_EQ(time.in_frames[project].cpu_us, 25);
  EXPECT_EQ(time.in_frames[integrate].cpu_us, 20);
  EXPECT_EQ(time.in_frames[sort].cpu_us, 5);
}

TEST(SharedClock, ThreadsShareTheInstantsTheyWorkInAndALoneOneHasThemAll) {
  const auto time = share({span(frame, 0, 0, 100), span(project, 0, 0, 100), span(sort, 1, 40, 60),
                           span(sort, 2, 40, 60), span(wait, 3, 0, 100)});
  EXPECT_EQ(time.in_frames[project].wall_us, 40 + 60 / 3.0);
  EXPECT_EQ(time.in_frames[sort].wall_us, 60 * 2 / 3.0);
  EXPECT_EQ(time.in_frames[wait].wall_us, 0);  // only others worked
  EXPECT_EQ(time.in_frames[wait].thread_us, 100);
  EXPECT_EQ(time.in_frames[sort].thread_us, 120);
  EXPECT_EQ(time.busy_us, 220);
  EXPECT_EQ(time.other_us, 0);
}

TEST(SharedClock, WaitingCountsOnceAndOnlyWhenNoThreadWorks) {
  const auto time = share({span(frame, 0, 0, 100), span(wait, 0, 0, 80), span(wait, 1, 10, 80), span(sort, 2, 20, 10)});
  EXPECT_EQ(time.in_frames[wait].wall_us, 80);
  EXPECT_EQ(time.in_frames[sort].wall_us, 10);
  EXPECT_EQ(time.other_us, 10);
}

TEST(SharedClock, FramesThatOverlapCountOnceAndWorkOutsideThemApart) {
  const auto time = share({span(frame, 0, 100, 50), span(frame, 0, 120, 80), span(frame, 0, 300, 10),
                           span(project, 0, 0, 110, 11), span(project, 0, 190, 120, 12)});
  EXPECT_EQ(time.frame_count, 3);
  EXPECT_EQ(time.frames.length(), 110);
  EXPECT_EQ(time.in_frames[project].wall_us, 10 + 10 + 10);
  EXPECT_EQ(time.outside[project].wall_us, 100 + 100);
  EXPECT_EQ(time.other_us, 80);
}

TEST(SharedClock, SpansThatDoNotNestLoseAndDoubleNoTime) {
  const auto time = share({span(frame, 0, 0, 100), span(project, 0, 10, 50), span(sort, 0, 40, 40)});
  EXPECT_EQ(time.in_frames[project].wall_us, 30);
  EXPECT_EQ(time.in_frames[sort].wall_us, 40);
  EXPECT_EQ(time.other_us, 30);
}

TEST(SharedClock, WithoutFramesTheWholeIsAllThereIs) {
  const auto time = share({span(project, 0, 10, 20), span(project, 0, 50, 10)});
  EXPECT_EQ(time.frame_count, 0);
  EXPECT_EQ(time.frames.length(), 50);
  EXPECT_EQ(time.other_us, 20);
  EXPECT_EQ(share({}).frames.length(), 0);
}

TEST(Breakdown, SeparateProjectorsAndCompositorsAddUpToTheWhole) {
  for (const bool shared : {false, true}) {
    const TracedPipeline pipeline{3, 2, shared};
    const analysis::RunTime run = run_of(pipeline);
    EXPECT_EQ(run.ranks, shared ? 3 : 5);
    EXPECT_EQ(run.frames, 3);
    ASSERT_EQ(run.roles.size(), 2u);
    const analysis::RoleTime& projectors = *run.role(TraceRole::projector);
    EXPECT_EQ(projectors.processes, 3);
    EXPECT_NEAR(projectors.whole.average_us, 300e3, rounding_us);
    expect_stage(projectors, "transform", 10, 10, 3);
    expect_stage(projectors, "project", 40, 2 * 38, 3);
    expect_stage(projectors, "sort", 10, 2 * 10, 3);
    expect_stage(projectors, "integrate", 15, 2 * 15, 3);
    expect_stage(projectors, "composite", 5, 2 * 5, 3);
    expect_stage(projectors, "pack", 4, 2 * 4, 3);
    expect_stage(projectors, "send", 6, 2 * 1, 3);
    expect_stage(projectors, "wait", 10, 0, 3);
    expect_stage(projectors, "other", 0, 0, 3);
    EXPECT_EQ(projectors.stage("send")->bytes, 3u * 3 * 2 * 1000);
    EXPECT_EQ(projectors.stage("send")->messages, 3u * 3 * 2 * 2);
    EXPECT_NEAR(projectors.stage("send")->thread_us, 3 * 3 * 2 * 6e3, rounding_us);
    EXPECT_NEAR(projectors.busy_threads, (10 + 2 * 80) / 100.0, 1e-6);
    EXPECT_NEAR(projectors.worst_wait_share, 0.1, 1e-6);

    const analysis::RoleTime& compositors = *run.role(TraceRole::compositor);
    EXPECT_EQ(compositors.processes, 2);
    expect_stage(compositors, "receive", 10, 5, 3);
    expect_stage(compositors, "wait", 60, 0, 3);
    expect_stage(compositors, "assemble", 5 / 2.0, 5 / 2.0, 3);
    expect_stage(compositors, "write", 5 / 2.0, 1 / 2.0, 3);
    expect_stage(compositors, "other", (5 + 15) / 2.0, 0, 3);
    EXPECT_NEAR(compositors.stage("assemble")->worst_us, 15e3, rounding_us);
    EXPECT_EQ(compositors.stage("assemble")->worst_rank, shared ? 0 : 3);

    for (const analysis::RoleTime& role : run.roles) {
      double sum = 0, shares = 0;
      for (const analysis::StageTime& stage : role.stages) sum += stage.average_us, shares += stage.share;
      EXPECT_NEAR(sum, role.whole.average_us, rounding_us);
      EXPECT_NEAR(shares, 1, 1e-6);
    }
  }
}

TEST(Breakdown, WorkOncePerMeshIsCountedSeparatelyWithItsWorstProcess) {
  const analysis::RunTime run = run_of({3, 1});
  const analysis::RoleTime& projectors = *run.role(TraceRole::projector);
  EXPECT_EQ(projectors.stage("read"), nullptr);
  ASSERT_EQ(projectors.outside.size(), 1u);
  EXPECT_EQ(projectors.outside[0].stage, "read");
  EXPECT_NEAR(projectors.outside[0].average_us, 300e3, rounding_us);
  EXPECT_NEAR(projectors.outside[0].worst_us, 400e3, rounding_us);
  EXPECT_EQ(projectors.outside[0].worst_rank, 2);
}

TEST(Breakdown, SynchronizesTheClocksOfRanks) {
  // On their own clocks the ranks would be 1000 s apart.
  const analysis::RunTime run = run_of({2, 1});
  EXPECT_NEAR(run.elapsed_us, 350e3, rounding_us);
  EXPECT_NEAR(run.kilotets_per_second.value(), 3 * 1e6 / 0.35 / 1000, 0.1);
}

TEST(Breakdown, OverlapCountsBytesMovedEarlyAndConcurrentFrames) {
  // Projectors send from 84 to 90 ms of each frame; their work ends at 84, their frame at 100. Compositors begin at 80
  // and receive for 10 ms.
  TracedPipeline pipeline{2, 2, false, 4};
  pipeline.compositors_begin_ms = 80;
  auto overlap = run_of(pipeline).overlap;
  EXPECT_NEAR(overlap.sent_before_projected.value(), 0, 1e-6);
  EXPECT_NEAR(overlap.sent_before_frame_end.value(), 1, 1e-6);
  EXPECT_NEAR(overlap.received_before_projected.value(), 0.4, 1e-6);
  EXPECT_NEAR(overlap.received_before_frame_end.value(), 1, 1e-6);
  EXPECT_EQ(overlap.frames, 3);
  EXPECT_EQ(overlap.frames_overlapping, 3);
  EXPECT_NEAR(overlap.overlapping_us, 3 * 80e3, rounding_us);

  // Compositors that begin after the projectors have ended receive nothing meanwhile, and a single frame at a time has
  // no overlap.
  pipeline.compositors_begin_ms = 100;
  pipeline.every_ms = 250;
  overlap = run_of(pipeline).overlap;
  EXPECT_NEAR(overlap.received_before_frame_end.value(), 0, 1e-6);
  EXPECT_EQ(overlap.frames, 3);
  EXPECT_EQ(overlap.frames_overlapping, 0);
}

TEST(Breakdown, OneProcessForBothHasNoExchange) {
  TraceFile trace;
  trace.stages = {"frame", "wait", "project", "sort", "integrate"};
  trace.spans = {span(frame, 0, 0, 100), span(project, 0, 0, 100)};
  const analysis::RunTime run = analysis::break_down(trace, "a");
  ASSERT_EQ(run.roles.size(), 1u);
  EXPECT_EQ(run.roles[0].role, TraceRole::both);
  EXPECT_EQ(run.frames, 1);
  EXPECT_FALSE(run.kilotets_per_second);
  EXPECT_FALSE(run.overlap.sent_before_projected);
  EXPECT_EQ(run.overlap.frames, 0);
}

TEST(Breakdown, SpansWithoutARoleGoToTheRoleOfTheirStage) {
  TraceFile trace;
  trace.stages = {"read", "write", "project", "composite"};
  const auto add = [&](std::uint16_t stage, int rank, TraceRole role) {
    FileSpan made = span(static_cast<Stage>(stage), stage, 10.0 * stage, 10);
    made.rank = rank;
    made.role = role;
    trace.spans.push_back(made);
  };
  add(0, 0, TraceRole::both), add(1, 0, TraceRole::both);
  add(2, 0, TraceRole::projector), add(3, 0, TraceRole::compositor);
  add(1, 1, TraceRole::both), add(2, 1, TraceRole::projector);
  const analysis::RunTime run = analysis::break_down(trace, "a");
  ASSERT_EQ(run.roles.size(), 2u);
  EXPECT_NE(run.roles[0].stage("read"), nullptr);
  EXPECT_EQ(run.roles[0].stage("write")->worst_rank, 1);
  EXPECT_EQ(run.roles[1].stage("read"), nullptr);
  EXPECT_NE(run.roles[1].stage("write"), nullptr);
}

TEST(Breakdown, ARankHasTheRolesOfItsFrames) {
  TraceFile trace;
  trace.stages = {"frame", "wait", "project", "sort"};
  for (const auto& [stage, role] :
       {std::pair{project, TraceRole::projector}, std::pair{frame, TraceRole::compositor}}) {
    trace.spans.push_back(span(stage, 0, stage == frame ? 50 : 0, 10));
    trace.spans.back().role = role;
  }
  const analysis::RunTime run = analysis::break_down(trace, "a");
  ASSERT_EQ(run.roles.size(), 1u);
  EXPECT_EQ(run.roles[0].role, TraceRole::compositor);
  ASSERT_EQ(run.roles[0].outside.size(), 1u);
  EXPECT_EQ(run.roles[0].outside[0].stage, "project");
}

TEST(Breakdown, EfficiencyIsTheRateACoreAgainstTheSmallestRunOfTheSameMesh) {
  // With twice the processes, frames take half the time in one run, and a quarter more than that in another run.
  std::vector<analysis::RunTime> runs = {run_of({4, 4, false, 20, 50, 50, 0}), run_of({2, 2, false, 20, 100, 100, 0}),
                                         run_of({4, 4, false, 20, 62.5, 62.5, 0})};
  TracedPipeline other{1, 1, false, 20, 100, 100, 0};
  other.tets = 5;
  runs.push_back(run_of(other));
  runs.push_back(runs[0]);
  runs.back().kilotets_per_second.reset();
  const auto found = analysis::efficiencies(runs);
  EXPECT_NEAR(found[0].value(), 1, 1e-6);
  EXPECT_NEAR(found[1].value(), 1, 1e-6);
  EXPECT_NEAR(found[2].value(), 0.8, 1e-6);
  EXPECT_NEAR(found[3].value(), 1, 1e-6);
  EXPECT_FALSE(found[4]);
}

}  // namespace
}  // namespace tessera::apps
