#include "scene/fill_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tessera::scene {

FillTally::FillTally(double low, double high) {
  for (const double end : {low, high})
    if (may_be_fill(end)) ends_[candidates_++] = {.value = end, .count = 0, .others = {}};
}

void FillTally::add(double value) {
  if (!std::isfinite(value)) return;
  for (std::size_t k = 0; k < candidates_; ++k)
    if (value == ends_[k].value) {
      ++ends_[k].count;
      return;
    }
  others_.low = std::min(others_.low, value), others_.high = std::max(others_.high, value);
}

void FillTally::add(const FillTally& part) {
  for (std::size_t k = 0; k < candidates_; ++k) ends_[k].count += part.ends_[k].count;
  others_.low = std::min(others_.low, part.others_.low), others_.high = std::max(others_.high, part.others_.high);
}

/// Far away: by half of what all others span, or of huge ones ten times that.
std::optional<FillValue> FillTally::found() const {
  const double span = others_.high - others_.low;
  if (!(span > 0) || !std::isfinite(span)) return std::nullopt;
  for (std::size_t k = 0; k < candidates_; ++k) {
    FillValue fill = ends_[k];
    fill.others = others_;
    const double gap = std::max(others_.low - fill.value, fill.value - others_.high);
    if (fill.count > 0 && gap > span * (fill.is_huge() ? 10 : 0.5)) return fill;
  }
  return std::nullopt;
}

bool may_be_fill(double value) {
  constexpr std::array usual = {999.0,    9999.0,    99999.0,  999999.0,      -999.0,   -9999.0,
                                -99999.0, -999999.0, -32767.0, -2147483648.0, -32768.0, -2147483647.0};
  // Some write one more digit behind the point: -9999.9, -999.25.
  return std::abs(value) >= huge_value ||
         std::any_of(usual.begin(), usual.end(), [&](double u) { return std::trunc(value) == u; });
}

std::optional<FillValue> find_fill_value(std::span<const double> values, double low, double high) {
  FillTally tally(low, high);
  if (!tally.has_candidates()) return std::nullopt;
  for (const double value : values) tally.add(value);
  return tally.found();
}

std::optional<FillValue> find_fill_value(const SampleSource& source, const ValueRange& range) {
  FillTally tally(range.low, range.high);
  if (range.empty() || !tally.has_candidates()) return std::nullopt;
  const SampleBox all = source.geometry().all_samples();
  std::vector<double> slice;
  for (std::int64_t k = all.low[2]; k < all.high[2]; ++k) {
    SampleBox box = all;
    box.low[2] = k, box.high[2] = k + 1;
    slice.resize(static_cast<std::size_t>(box.count()));
    source.read(box, std::span<double>(slice));
    for (const double sample : slice) tally.add(source.grid().value(sample));
  }
  return tally.found();
}

std::string words_on(const FillValue& fill, const char* things) {
  const double margin = (fill.others.high - fill.others.low) / 100;
  return fmt::format(
      "{} {} have the value {:.7g}, which looks like a fill value and rules range and colours: "
      "`threshold` {:.7g},{:.7g} leaves them out",
      fill.count == 0 ? "some" : fmt::format("{}", fill.count), things, fill.value, fill.others.low - margin,
      fill.others.high + margin);
}

}  // namespace tessera::scene
