// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/timing_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tessera::analysis {
namespace {

/// Times of one table share a unit and a number of digits, chosen by the largest time.
struct TimeUnit {
  const char* name;
  double us;
  int digits;
  [[nodiscard]] std::string operator()(double time_us) const { return fmt::format("{:.{}f}", time_us / us, digits); }
};

TimeUnit unit_for(double largest_us) {
  if (largest_us >= 1e7) return {"s", 1e6, 2};
  if (largest_us >= 1e5) return {"ms", 1e3, 1};
  return {"ms", 1e3, 3};
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

std::string bytes_words(double bytes) {
  if (bytes >= 1e9) return fmt::format("{:.2f} GB", bytes * 1e-9);
  if (bytes >= 1e6) return fmt::format("{:.2f} MB", bytes * 1e-6);
  return fmt::format("{:.2f} kB", bytes * 1e-3);
}

const char* title(TraceRole role) {
  return role == TraceRole::projector ? "Projectors" : role == TraceRole::compositor ? "Compositors" : "Process";
}

std::string count(std::uint64_t number, const char* one, const char* many) {
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

std::string head(const RunTime& run) {
  const TraceRun& of = run.run;
  std::string mesh = of.input.empty() ? "" : of.input + ", ";
  if (of.tets > 0) mesh += fmt::format("{} tets, ", of.tets);
  std::string text =
      fmt::format("{}\n  {}{}", run.name, mesh, count(static_cast<std::uint64_t>(run.frames), "frame", "frames"));
  if (of.width > 0) text += fmt::format(" of {}x{}", of.width, of.height);
  text += "\n  " + count(static_cast<std::uint64_t>(run.ranks), "process", "processes");
  if (run.role(TraceRole::both) == nullptr) text += ": " + process_words(run);
  if (of.threads > 0)
    text += fmt::format(", {}", count(static_cast<std::uint64_t>(of.threads), "thread each", "threads each"));
  if (!of.exchange.empty()) text += fmt::format("; exchange {}", of.exchange);
  if (!of.rasterizer.empty()) text += fmt::format("; {}", of.rasterizer);
  if (!of.integrator.empty()) text += fmt::format("; {}", of.integrator);
  if (of.parts > 0)
    text += fmt::format("; {:.3g} % in double precision",
                        100 * static_cast<double>(of.parts_in_double_precision) / static_cast<double>(of.parts));
  text += fmt::format("\n  {:.3f} s for the frames, {:.1f} ms per frame", run.elapsed_us * 1e-6,
                      run.elapsed_us * 1e-3 / run.frames);
  if (run.kilotets_per_second) text += fmt::format(", {:.0f} kTets/s", *run.kilotets_per_second);
  if (of.ranks > run.ranks)
    text += fmt::format("\n  the trace contains {} of the run's {} processes", run.ranks, of.ranks);
  return text + "\n";
}

std::string role_table(const RunTime& run, const RoleTime& role) {
  const double frames = run.frames;
  const TimeUnit unit = unit_for(role.whole.worst_us / frames);
  const bool several = role.processes > 1;
  std::string text = fmt::format("\n{}: {}, {} a frame; {:.2f} threads busy\n", title(role.role),
                                 count(static_cast<std::uint64_t>(role.processes), "process", "processes"), unit.name,
                                 role.busy_threads);
  if (!role.has_frames) text += "  no spans of frames: the time from the first span to the last counts as one frame\n";
  text += fmt::format("  {:<11}{:>10}{:>10}{:>9}", "stage", several ? "average" : "wall", "share", "cpu");
  text += several ? fmt::format("{:>11}{:>9}\n", "worst", "on rank") : "\n";
  const auto line = [&](const StageTime& stage) {
    const bool unmeasured = stage.stage == "other";
    text += fmt::format("  {:<11}{:>10}{:>10}{:>9}", stage.stage, unit(stage.average_us / frames), percent(stage.share),
                        unmeasured ? "" : unit(stage.cpu_us / frames));
    if (several) text += fmt::format("{:>11}{:>9}", unit(stage.worst_us / frames), stage.worst_rank);
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  };
  for (const StageTime& stage : role.stages) line(stage);
  line(role.whole);
  const char* separator = "  outside of the frames, in all: ";
  for (const StageTime& stage : role.outside) {
    if (stage.worst_us < 500) continue;  // the time would be printed as 0.000
    text += fmt::format("{}{} {:.3f} s", std::exchange(separator, ", "), stage.stage, stage.average_us * 1e-6);
    if (several) text += fmt::format(" (worst {:.3f} s, rank {})", stage.worst_us * 1e-6, stage.worst_rank);
  }
  return *separator == ',' ? text + "\n" : text;
}

std::string exchange_table(const RunTime& run) {
  std::string text;
  for (const RoleTime& role : run.roles) {
    const double frames = run.frames;
    const TimeUnit unit = unit_for(role.whole.worst_us / frames);
    StageTime moving;
    bool any = false;
    std::string lines;
    const auto line = [&](const std::string& name, const StageTime& stage, const std::string& rest) {
      lines += fmt::format("  {:<12}{:<9}{:>10} {:<3}{:>9}{}\n", any ? "" : title(role.role), name,
                           unit(stage.average_us / frames), unit.name, percent(stage.share), rest);
      any = true;
    };
    for (const char* name : {"pack", "send", "receive"}) {
      const StageTime* stage = role.stage(name);
      if (stage == nullptr) continue;
      const double bytes = static_cast<double>(stage->bytes);
      line(name, *stage,
           fmt::format("{:>13}{:>11.0f}{:>10}", bytes_words(bytes / frames),
                       static_cast<double>(stage->messages) / frames,
                       bytes > 0 && stage->thread_us > 0 ? fmt::format("{:.0f}", bytes / stage->thread_us) : ""));
      moving.average_us += stage->average_us;
      moving.share += stage->share;
    }
    const StageTime* wait = role.stage("wait");
    if (any) line("moving", moving, "");
    if (wait != nullptr)
      line("waiting", *wait,
           role.processes > 1
               ? fmt::format("   worst {} on rank {}", percent(role.worst_wait_share), role.worst_wait_rank)
               : "");
    text += lines;
  }
  if (text.empty()) return "";
  return fmt::format("\nExchange, a frame\n  {:<12}{:<9}{:>10} {:<3}{:>9}{:>13}{:>11}{:>10}\n", "", "", "average", "",
                     "share", "bytes", "messages", "MB/s") +
         text;
}

std::string overlap_text(const RunTime& run) {
  const Overlap& overlap = run.overlap;
  std::string text;
  if (overlap.sent_before_projected || overlap.received_before_projected) {
    text +=
        fmt::format("  {:<45}{:>11}{:>11}\n", "bytes moved before the last projector ended", "projecting", "its frame");
    const auto line = [&](const char* name, const std::optional<double>& work, const std::optional<double>& frame) {
      if (work) text += fmt::format("  {:<45}{:>11}{:>11}\n", name, percent(*work), percent(*frame));
    };
    line("  handed over by projectors", overlap.sent_before_projected, overlap.sent_before_frame_end);
    line("  taken in by compositors", overlap.received_before_projected, overlap.received_before_frame_end);
  }
  if (overlap.frames > 0)
    text += fmt::format(
        "  {} of {} frames began projecting before the previous frame was composited; two frames overlapped for {} of "
        "the time\n",
        overlap.frames_overlapping, overlap.frames,
        percent(run.elapsed_us > 0 ? overlap.overlapping_us / run.elapsed_us : 0));
  return text.empty() ? "" : "\nOverlap\n" + text;
}

std::string csv_word(const std::string& word) {
  if (word.find_first_of(",\"\r\n") == std::string::npos) return word;
  std::string quoted = "\"";
  for (const char c : word) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string process_words(const RunTime& run) {
  const RoleTime* projectors = run.role(TraceRole::projector);
  const RoleTime* compositors = run.role(TraceRole::compositor);
  if (projectors == nullptr && compositors == nullptr)
    return run.ranks == 1 ? "1 process" : fmt::format("{} processes", run.ranks);
  const int n = projectors != nullptr ? projectors->processes : 0,
            p = compositors != nullptr ? compositors->processes : 0;
  if (n + p == run.ranks) return fmt::format("{} + {}", n, p);
  return n == p && n == run.ranks ? fmt::format("{} shared", n) : fmt::format("{} + {} shared", n, p);
}

std::string breakdown_text(const RunTime& run) {
  std::string text = head(run);
  for (const RoleTime& role : run.roles) text += role_table(run, role);
  return text + exchange_table(run) + overlap_text(run);
}

std::string scaling_text(std::span<const RunTime> runs) {
  std::size_t widest = 5;
  for (const RunTime& run : runs) widest = std::max(widest, run.name.size());
  std::string text = fmt::format("{:<{}}  {:>9}  {:<14}{:>8}{:>12}{:>11}{:>11}{:>12}\n", "trace", widest, "processes",
                                 "roles", "threads", "Mtets", "ms/frame", "kTets/s", "efficiency");
  const auto efficiency = efficiencies(runs);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunTime& run = runs[i];
    const auto threads = run.run.threads;
    text += fmt::format("{:<{}}  {:>9}  {:<14}{:>8}{:>12}{:>11.1f}{:>11}{:>12}\n", run.name, widest, run.ranks,
                        process_words(run), threads > 0 ? std::to_string(threads) : "-",
                        run.run.tets > 0 ? fmt::format("{:.3f}", static_cast<double>(run.run.tets) * 1e-6) : "-",
                        run.elapsed_us * 1e-3 / run.frames,
                        run.kilotets_per_second ? fmt::format("{:.0f}", *run.kilotets_per_second) : "-",
                        efficiency[i] ? fmt::format("{:.2f}", *efficiency[i]) : "-");
  }
  return text;
}

std::string reading_text() {
  return R"(How to read it: each instant of a process's frames goes to the stages that its threads are in, evenly if they are in
several; `wait` counts while nothing else runs, `other` while no thread is in any stage. So the stages add up to the
whole. `cpu` is CPU time of the threads that recorded a stage; more than the wall time means several at once.
`MB/s` is bytes over the time of the threads in that stage; `send` is handing over to MPI, which may move them later.
)";
}

std::string breakdown_csv(std::span<const RunTime> runs) {
  std::string text =
      "trace,input,tets,width,height,processes,projectors,compositors,threads_per_process,frames,frame_ms,ktets_per_s,"
      "efficiency,role,role_processes,part,stage,average_ms,worst_ms,worst_rank,share,cpu_ms,bytes,messages\n";
  const auto efficiency = efficiencies(runs);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunTime& run = runs[i];
    const auto processes = [&](TraceRole role) { return run.role(role) != nullptr ? run.role(role)->processes : 0; };
    const auto optional = [](const std::optional<double>& value) { return value ? fmt::format("{:.6g}", *value) : ""; };
    const auto known = [](auto number) { return number > 0 ? fmt::format("{}", number) : ""; };
    const std::string of_run = fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{:.6g},{},{}", csv_word(run.name), csv_word(run.run.input), known(run.run.tets),
        known(run.run.width), known(run.run.height), run.ranks, processes(TraceRole::projector),
        processes(TraceRole::compositor), known(run.run.threads), run.frames, run.elapsed_us * 1e-3 / run.frames,
        optional(run.kilotets_per_second), optional(efficiency[i]));
    for (const RoleTime& role : run.roles) {
      const char* name = role.role == TraceRole::projector    ? "projector"
                         : role.role == TraceRole::compositor ? "compositor"
                                                              : "both";
      const auto line = [&](const char* part, const StageTime& stage, double times) {
        text += fmt::format("{},{},{},{},{},{:.6g},{:.6g},{},{:.6g},{:.6g},{},{}\n", of_run, name, role.processes, part,
                            csv_word(stage.stage), stage.average_us * 1e-3 / times, stage.worst_us * 1e-3 / times,
                            stage.worst_rank, stage.share, stage.cpu_us * 1e-3 / times, stage.bytes, stage.messages);
      };
      for (const StageTime& stage : role.stages) line("frame", stage, run.frames);
      line("frame", role.whole, run.frames);
      for (const StageTime& stage : role.outside) line("once", stage, 1);
    }
  }
  return text;
}

}  // namespace tessera::analysis
