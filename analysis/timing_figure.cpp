// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/timing_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/timing_text.hpp"
#include "tessera/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::analysis {
namespace {

/// The stages that share a colour in a bar, from the bottom up. Stages that no kind lists are added to the last.
struct Kind {
  std::string_view label;
  std::uint32_t rgb;
  std::array<std::string_view, 4> stages;
};
constexpr std::array<Kind, 10> kinds = {{
    {"transform, cull, bin", 0x56b4e9, {"prepare", "transform", "cull", "bin"}},
    {"project", 0x0072b2, {"project"}},
    {"sort", 0xe69f00, {"sort"}},
    {"integrate", 0x009e73, {"integrate"}},
    {"composite", 0xf0e442, {"composite"}},
    {"exchange: moving", 0xcc79a7, {"pack", "send", "receive"}},
    {"exchange: waiting", 0xd55e00, {"wait"}},
    {"assemble", 0x7f7f7f, {"assemble"}},
    {"write", 0x3f3f3f, {"write"}},
    {"other", 0xd9d9d9, {}},
}};

using Bar = std::array<double, kinds.size()>;  ///< time per frame of each kind

Bar bar_of(const RoleTime& role, double frames) {
  Bar bar{};
  for (const StageTime& stage : role.stages) {
    const auto kind = std::find_if(kinds.begin(), kinds.end() - 1, [&](const Kind& k) {
      return std::find(k.stages.begin(), k.stages.end(), stage.stage) != k.stages.end();
    });
    bar[static_cast<std::size_t>(kind - kinds.begin())] += stage.average_us / frames;
  }
  return bar;
}

/// The first of 1, 2, 5, 10, 20, ... that divides `range` into at most eight parts.
double tick_step(double range) {
  double step = std::pow(10, std::floor(std::log10(range / 8)));
  for (const double factor : {2.0, 2.5, 2.0})
    if (range / step > 8) step *= factor;
  return step;
}

std::string three_digits(double value) {
  return fmt::format("{:.{}f}", value, value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3);
}

class Figure {
 public:
  explicit Figure(std::span<const RunTime> runs) : runs_(runs) {
    double most = 0;
    for (const TraceRole role : {TraceRole::projector, TraceRole::compositor, TraceRole::both}) {
      Panel panel{role, {}};
      for (const RunTime& run : runs)
        if (run.role(role) != nullptr) panel.runs.push_back(&run);
      if (!panel.runs.empty()) panels_.push_back(std::move(panel));
    }
    for (const RunTime& run : runs)
      for (const RoleTime& role : run.roles) {
        most = std::max(most, role.whole.worst_us / run.frames);
        const Bar bar = bar_of(role, run.frames);
        for (std::size_t k = 0; k < kinds.size(); ++k)
          used_[k] = used_[k] || bar[k] > 1e-3 * role.whole.average_us / run.frames;
      }
    const bool seconds = most >= 1e7;
    unit_ = seconds ? 1e6 : 1e3;
    unit_name_ = seconds ? "s" : "ms";
    step_ = tick_step(std::max(most / unit_, 1e-6));
    top_ = step_ * std::max(1.0, std::ceil(most / unit_ / step_ * 1.04));
    for (const RunTime& run : runs) {
      const auto same = [&](const RunTime& other) { return process_words(other) == process_words(run); };
      name_files_ = name_files_ || std::count_if(runs.begin(), runs.end(), same) > 1;
    }
  }

  [[nodiscard]] double width() const {
    double sum = left + legend_width;
    for (const Panel& panel : panels_) sum += panel_width(panel) + gap;
    return sum;
  }
  [[nodiscard]] static double height() { return above + plot_height + below; }

  void draw(Canvas& canvas) const {
    canvas.rectangle(0, 0, width(), height(), 0xffffff);
    canvas.upward_text(18, above + plot_height / 2,
                       fmt::format("time per frame, {}, average over processes", unit_name_), 11);
    double x = left;
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      draw_panel(canvas, i, x);
      x += panel_width(panels_[i]) + gap;
    }
    draw_legend(canvas, x);
  }

 private:
  struct Panel {
    TraceRole role;
    std::vector<const RunTime*> runs;
  };

  static constexpr double left = 62, above = 40, below = 72, gap = 28, plot_height = 320, legend_width = 150;

  [[nodiscard]] double pitch() const { return std::clamp(420.0 / static_cast<double>(runs_.size()), 56.0, 84.0); }
  /// Width of a panel, which is sufficient for the title below the panel.
  [[nodiscard]] double panel_width(const Panel& panel) const {
    return std::max(190.0, pitch() * static_cast<double>(panel.runs.size()) + 16);
  }
  [[nodiscard]] double y(double time_us) const { return above + plot_height * (1 - time_us / unit_ / top_); }

  void draw_panel(Canvas& canvas, std::size_t number, double x) const {
    const Panel& panel = panels_[number];
    const double width = panel_width(panel);
    const char* title = panel.role == TraceRole::projector    ? "Projectors"
                        : panel.role == TraceRole::compositor ? "Compositors"
                                                              : "One process for both";
    canvas.text(
        x, above - 16,
        panels_.size() > 1 ? fmt::format("{}) {}", static_cast<char>('a' + static_cast<int>(number)), title) : title,
        13);
    for (int tick = 0; tick * step_ <= top_ * 1.0001; ++tick) {
      const double at = y(tick * step_ * unit_);
      canvas.line(x, at, x + width, at, 0.7, tick == 0 ? 0x222222 : 0xe4e4e4);
      if (number == 0) canvas.text(x - 7, at + 3.5, fmt::format("{:g}", tick * step_), 10, 1);
    }
    const double offset = (width - pitch() * static_cast<double>(panel.runs.size())) / 2;
    for (std::size_t i = 0; i < panel.runs.size(); ++i) {
      const RunTime& run = *panel.runs[i];
      const double middle = x + offset + pitch() * (static_cast<double>(i) + 0.5);
      draw_bar(canvas, middle, *run.role(panel.role), run.frames);
      canvas.text(middle, above + plot_height + 16, process_words(run), 10, 0.5);
      if (name_files_) canvas.text(middle, above + plot_height + 30, file_words(canvas, run), 8.5, 0.5, 0x777777);
    }
    if (panel.role != TraceRole::both)
      canvas.text(x + width / 2, above + plot_height + 50, "processes (projectors + compositors)", 10, 0.5);
  }

  [[nodiscard]] std::string file_words(Canvas& canvas, const RunTime& run) const {
    // Cairo reports an error for text that is not UTF-8.
    std::string stem = printable_ascii(std::filesystem::path(run.name).stem().string());
    while (stem.size() > 1 && canvas.text_width(stem, 8.5) > pitch() - 3) stem.pop_back();
    return stem;
  }

  void draw_bar(Canvas& canvas, double middle, const RoleTime& role, double frames) const {
    const double width = pitch() * 0.62, x = middle - width / 2;
    const Bar bar = bar_of(role, frames);
    double from = 0;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      if (!(bar[k] > 0)) continue;
      const double top = y(from + bar[k]), bottom = y(from);
      canvas.rectangle(x, top, width, bottom - top, kinds[k].rgb);
      if (bottom - top > 3) canvas.line(x, top, x + width, top, 1, 0xffffff);
      if (bottom - top > 13 && role.whole.average_us > 0) {
        const bool dark = kinds[k].rgb == 0x0072b2 || kinds[k].rgb == 0x3f3f3f || kinds[k].rgb == 0x009e73 ||
                          kinds[k].rgb == 0xd55e00 || kinds[k].rgb == 0x7f7f7f;
        canvas.text(middle, (top + bottom) / 2 + 3.2,
                    fmt::format("{:.0f} %", 100 * bar[k] * frames / role.whole.average_us), 9, 0.5,
                    dark ? 0xffffff : 0x222222);
      }
      from += bar[k];
    }
    // A line for the worst process, if its time differs by more than the width of the line.
    const double worst = y(role.whole.worst_us / frames);
    if (role.processes > 1 && y(from) - worst > 1) {
      canvas.line(middle, y(from), middle, worst, 1, 0x222222);
      canvas.line(middle - 6, worst, middle + 6, worst, 1.4, 0x222222);
    }
    canvas.text(middle, std::min(worst, y(from)) - 4, three_digits(role.whole.average_us / frames / unit_), 9.5, 0.5);
  }

  void draw_legend(Canvas& canvas, double x) const {
    double at = above + 6;
    for (std::size_t k = kinds.size(); k-- > 0;) {
      if (!used_[k]) continue;
      canvas.rectangle(x, at - 8, 11, 11, kinds[k].rgb);
      canvas.text(x + 17, at + 1.5, std::string(kinds[k].label), 10.5);
      at += 19;
    }
    const bool several = std::any_of(runs_.begin(), runs_.end(), [](const RunTime& run) { return run.ranks > 1; });
    if (!several) return;
    at += 6;
    canvas.line(x + 5.5, at + 3, x + 5.5, at - 8, 1, 0x222222);
    canvas.line(x, at - 8, x + 11, at - 8, 1.4, 0x222222);
    canvas.text(x + 17, at + 1.5, "worst process", 10.5);
  }

  std::span<const RunTime> runs_;
  std::vector<Panel> panels_;
  std::array<bool, kinds.size()> used_{};
  double unit_, step_, top_;
  const char* unit_name_;
  bool name_files_ = false;  ///< whether files are named, because the numbers of processes do not distinguish the runs
};

}  // namespace

void write_figure(std::span<const RunTime> runs, const std::filesystem::path& file) {
  check_figure_path(file);
  constexpr std::size_t most_runs = 60;
  if (runs.size() > most_runs)
    throw bad_input(fmt::format("{}: {} traces do not fit into one figure; give at most {}", file.string(), runs.size(),
                                most_runs));
  const Figure figure(runs);
  write_drawing(figure.width(), Figure::height(), file, [&](Canvas& canvas) { figure.draw(canvas); });
}

}  // namespace tessera::analysis
