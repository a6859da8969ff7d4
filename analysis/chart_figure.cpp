// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/chart_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "analysis/canvas.hpp"

namespace tessera::analysis {
namespace {

// The colours of Okabe, Ito, "Color Universal Design", 2008, and two greys. Further families use the same colours with
// another mark.
constexpr std::array<std::uint32_t, 8> colors = {0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7,
                                                 0xe69f00, 0x56b4e9, 0x7f7f7f, 0x222222};
constexpr double least_error = 1e-9;  // smaller errors, including 0, are drawn at this error

std::uint32_t paler(std::uint32_t rgb) {
  std::uint32_t result = 0;
  for (int shift = 0; shift < 24; shift += 8) {
    const double value = rgb >> shift & 255;
    result |= static_cast<std::uint32_t>(255 - 0.4 * (255 - value)) << shift;
  }
  return result;
}

std::string decade(int power) {
  return power >= -2 && power <= 4 ? fmt::format("{:g}", std::pow(10.0, power)) : fmt::format("1e{}", power);
}

class Chart {
 public:
  Chart(std::span<const ChartPoint> points, const std::string& title, const std::string& subtitle)
      : title_(title), subtitle_(subtitle) {
    for (const ChartPoint& p : points) {
      if (!p.measured()) continue;
      points_.push_back(&p);
      if (std::find(families_.begin(), families_.end(), p.family) == families_.end()) families_.push_back(p.family);
    }
    double fastest = 1e300, slowest = 0, best = 1e300, worst = 0;
    for (const ChartPoint* p : points_) {
      fastest = std::min(fastest, p->min_ms()), slowest = std::max(slowest, p->max_ms());
      best = std::min(best, error(*p)), worst = std::max(worst, error(*p));
    }
    if (points_.empty()) fastest = 1, slowest = 10, best = 1e-4, worst = 1;
    x_low_ = std::log10(fastest) - 0.12, x_high_ = std::log10(slowest) + 0.25;
    y_low_ = std::floor(std::log10(best) - 0.1), y_high_ = std::min(1.0, std::ceil(std::log10(worst) + 0.1));
    if (x_high_ - x_low_ < 0.8) x_high_ = x_low_ + 0.8;
    if (y_high_ <= y_low_) y_high_ = y_low_ + 1;
  }

  static constexpr double width = 900, height = 560;

  void draw(Canvas& canvas) const {
    canvas.rectangle(0, 0, width, height, 0xffffff);
    canvas.text(left, 22, title_, 14);
    canvas.text(left, 40, subtitle_, 10, 0, 0x666666);
    axes(canvas);
    front(canvas);
    for (std::size_t f = 0; f < families_.size(); ++f) family(canvas, f);
    labels(canvas);
    legend(canvas);
  }

 private:
  static constexpr double left = 66, top = 56, right = 200, bottom = 48;

  static double error(const ChartPoint& p) { return std::clamp(p.error.max, least_error, 10.0); }
  [[nodiscard]] double x(double ms) const {
    return left + (std::log10(ms) - x_low_) / (x_high_ - x_low_) * (width - left - right);
  }
  [[nodiscard]] double y(double e) const {
    return top + (y_high_ - std::log10(e)) / (y_high_ - y_low_) * (height - top - bottom);
  }
  [[nodiscard]] std::size_t family_of(const ChartPoint& p) const {
    return static_cast<std::size_t>(std::find(families_.begin(), families_.end(), p.family) - families_.begin());
  }

  void axes(Canvas& canvas) const {
    const double floor = height - bottom, end = width - right;
    for (int power = static_cast<int>(std::floor(x_low_)); power <= x_high_; ++power)
      for (int digit = 1; digit < 10; ++digit) {
        const double ms = digit * std::pow(10.0, power);
        if (std::log10(ms) < x_low_ || std::log10(ms) > x_high_) continue;
        canvas.line(x(ms), top, x(ms), floor, 0.6, digit == 1 ? 0xcccccc : 0xf0f0f0);
        const bool few = x_high_ - x_low_ < 2.2;
        if (digit == 1 || (few && (digit == 2 || digit == 5)))
          canvas.text(x(ms), floor + 15, fmt::format("{:g}", ms), 10, 0.5);
      }
    for (int power = static_cast<int>(y_low_); power <= y_high_; ++power) {
      const double at = y(std::pow(10.0, power));
      canvas.line(left, at, end, at, 0.6, 0xcccccc);
      canvas.text(left - 6, at + 3.5, decade(power), 10, 1);
    }
    canvas.text((left + end) / 2, height - 12, "frame, ms (median; bar: fastest to slowest)", 11, 0.5);
    canvas.upward_text(18, (top + floor) / 2, "largest error in linear RGBA", 11);
  }

  /// Draws the Pareto front as steps. No measured method is below and to the left of this line.
  void front(Canvas& canvas) const {
    std::vector<const ChartPoint*> best;
    for (const ChartPoint* p : points_)
      if (p->on_front) best.push_back(p);
    std::sort(best.begin(), best.end(), [](auto* a, auto* b) { return a->median_ms() < b->median_ms(); });
    for (std::size_t i = 0; i < best.size(); ++i) {
      const double here_x = x(best[i]->median_ms()), here_y = y(error(*best[i]));
      const double next_x = i + 1 < best.size() ? x(best[i + 1]->median_ms()) : width - right;
      canvas.line(here_x, here_y, next_x, here_y, 2.5, 0xbbbbbb);
      if (i + 1 < best.size()) canvas.line(next_x, here_y, next_x, y(error(*best[i + 1])), 2.5, 0xbbbbbb);
    }
  }

  void mark(Canvas& canvas, double at_x, double at_y, std::size_t family, bool bold) const {
    const std::uint32_t color = colors[family % colors.size()];
    const double r = bold ? 4.5 : 3.5;
    const std::uint32_t shade = bold ? color : paler(color);
    if (family / colors.size() % 2 == 0)
      canvas.disc(at_x, at_y, r, shade);
    else
      canvas.rectangle(at_x - r, at_y - r, 2 * r, 2 * r, shade);
  }

  void family(Canvas& canvas, std::size_t number) const {
    std::vector<const ChartPoint*> mine;
    for (const ChartPoint* p : points_)
      if (p->family == families_[number]) mine.push_back(p);
    std::sort(mine.begin(), mine.end(), [](auto* a, auto* b) { return a->error.max < b->error.max; });
    const std::uint32_t pale = paler(colors[number % colors.size()]);
    for (std::size_t i = 0; i < mine.size(); ++i) {
      const ChartPoint& p = *mine[i];
      const double at_x = x(p.median_ms()), at_y = y(error(p));
      if (i > 0) canvas.line(x(mine[i - 1]->median_ms()), y(error(*mine[i - 1])), at_x, at_y, 1, pale);
      canvas.line(x(p.min_ms()), at_y, x(p.max_ms()), at_y, 1.4, pale);
    }
    for (const ChartPoint* p : mine) mark(canvas, x(p->median_ms()), y(error(*p)), number, p->on_front);
  }

  /// Labels each point with the part of its name that differs from the family's, if there is space. Points of the front
  /// are labelled first.
  void labels(Canvas& canvas) const {
    struct Taken {
      double x0, y0, x1, y1;
    };
    std::vector<Taken> taken;
    const auto put = [&](const ChartPoint& p, bool bold) {
      const std::string& words = bold ? p.name : p.name.substr(std::min(p.name.find_last_of(" :") + 1, p.name.size()));
      const double size = bold ? 10 : 8.5, wide = canvas.text_width(words, size);
      const double at_x = x(p.median_ms()), at_y = y(error(p));
      const std::pair<double, double> places[] = {{7, 3.5},          {-7 - wide, 3.5}, {-0.5 * wide, -8},
                                                  {-0.5 * wide, 15}, {7, -7},          {7, 13}};
      for (const auto& [dx, dy] : places) {
        const Taken place{at_x + dx, at_y + dy - size, at_x + dx + wide, at_y + dy + 2};
        const bool free = std::none_of(taken.begin(), taken.end(), [&](const Taken& t) {
          return place.x0 < t.x1 && t.x0 < place.x1 && place.y0 < t.y1 && t.y0 < place.y1;
        });
        if (!free || place.x0 < left || place.x1 > width) continue;
        canvas.rectangle(place.x0 - 1, place.y0 + 1, wide + 2, size + 1, 0xffffff);  // hides lines behind the text
        canvas.text(place.x0, at_y + dy, words, size, 0, bold ? 0x222222 : 0x888888);
        taken.push_back(place);
        return;
      }
    };
    for (const ChartPoint* p : points_)
      taken.push_back({x(p->median_ms()) - 4, y(error(*p)) - 4, x(p->median_ms()) + 4, y(error(*p)) + 4});
    for (const bool bold : {true, false})
      for (const ChartPoint* p : points_)
        if (p->on_front == bold) put(*p, bold);
  }

  void legend(Canvas& canvas) const {
    double at = top + 8;
    const double from = width - right + 16;
    for (std::size_t f = 0; f < families_.size(); ++f) {
      const bool bold = std::any_of(points_.begin(), points_.end(),
                                    [&](const ChartPoint* p) { return p->on_front && p->family == families_[f]; });
      mark(canvas, from, at - 3.5, f, bold);
      canvas.text(from + 10, at, families_[f], 10, 0, bold ? 0x222222 : 0x888888);
      at += 17;
    }
    at += 6;
    canvas.line(from - 5, at - 3.5, from + 5, at - 3.5, 2.5, 0xbbbbbb);
    canvas.text(from + 10, at, "Pareto front", 10);
  }

  std::string title_, subtitle_;
  std::vector<const ChartPoint*> points_;
  std::vector<std::string> families_;
  double x_low_, x_high_, y_low_, y_high_;  ///< ends of the axes, as exponents of ten
};

}  // namespace

void write_chart(std::span<const ChartPoint> points, const std::string& title, const std::string& subtitle,
                 const std::filesystem::path& file) {
  const Chart chart(points, title, subtitle);
  write_drawing(Chart::width, Chart::height, file, [&](Canvas& canvas) { chart.draw(canvas); });
}

}  // namespace tessera::analysis
