// SPDX-License-Identifier: BSD-3-Clause
#include "scene/fill_value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tessera::scene {

void FillTally::add(double value, std::uint64_t count) {
  if (!std::isfinite(value)) return;
  const auto end = usual_.begin() + static_cast<std::ptrdiff_t>(usuals_);
  const auto known = std::find_if(usual_.begin(), end, [&](const Usual& u) { return u.value == value; });
  if (known != end)
    known->count += count;
  else if (usuals_ < usual_.size() && may_be_fill(value))
    usual_[usuals_++] = {value, count};
  else
    others_.low = std::min(others_.low, value), others_.high = std::max(others_.high, value);
}

void FillTally::add(const FillTally& part) {
  for (std::size_t k = 0; k < part.usuals_; ++k) add(part.usual_[k].value, part.usual_[k].count);
  others_.low = std::min(others_.low, part.others_.low), others_.high = std::max(others_.high, part.others_.high);
}

/// The distance of a fill value from all other values must be more than half of their range, and that of a huge fill
/// value more than ten times their range. Huge fill values take precedence over others.
std::optional<FillValue> FillTally::found() const {
  ValueRange others = others_;
  const auto gap_to = [&](const Usual& u) { return std::max(others.low - u.value, u.value - others.high); };
  const auto is_huge = [](const Usual& u) { return std::abs(u.value) >= huge_value; };
  const auto is_far = [&](const Usual& u) {
    const double span = others.high - others.low;
    return span > 0 && std::isfinite(span) && gap_to(u) > span * (is_huge(u) ? 10 : 0.5);
  };
  const auto take_for_other = [&](const Usual& u) {
    others.low = std::min(others.low, u.value), others.high = std::max(others.high, u.value);
    return true;
  };
  std::vector<Usual> far(usual_.begin(), usual_.begin() + static_cast<std::ptrdiff_t>(usuals_));
  std::ranges::sort(far, {}, gap_to);
  std::erase_if(far, [&](const Usual& u) { return !is_far(u) && take_for_other(u); });
  if (far.empty()) return std::nullopt;
  if (is_huge(far.back())) std::erase_if(far, [&](const Usual& u) { return !is_huge(u) && take_for_other(u); });
  FillValue fill{.value = far.back().value, .count = 0, .others = others, .values = {}};
  for (const Usual& u : far) fill.count += u.count, fill.values.push_back(u.value);
  std::ranges::sort(fill.values);
  return fill;
}

bool may_be_fill(double value) {
  constexpr std::array usual = {999.0,    9999.0,    99999.0,      999999.0,    -999.0,        -9999.0,
                                -99999.0, -999999.0, -32767.0,     -32768.0,    -2147483647.0, -2147483648.0,
                                32767.0,  65535.0,   2147483647.0, 4294967295.0};
  // Some programs add a digit after the decimal point: -9999.9, -999.25.
  return std::abs(value) >= huge_value ||
         std::any_of(usual.begin(), usual.end(), [&](double u) { return std::trunc(value) == u; });
}

std::optional<FillValue> find_fill_value(std::span<const double> values, double low, double high) {
  if (!may_be_fill(low) && !may_be_fill(high)) return std::nullopt;
  FillTally tally;
  for (const double value : values) tally.add(value);
  return tally.found();
}

std::optional<FillValue> find_fill_value(const SampleSource& source, const ValueRange& range) {
  if (range.empty() || (!may_be_fill(range.low) && !may_be_fill(range.high))) return std::nullopt;
  FillTally tally;
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
  const bool is_one = fill.values.size() == 1;
  return fmt::format(
      "{} {} have the value{} {:.7g}, which look{} like {}fill value{} and rule{} range and colours: "
      "`threshold` {:.7g},{:.7g} leaves them out",
      fill.count == 0 ? "some" : fmt::format("{}", fill.count), things, is_one ? "" : "s",
      fmt::join(fill.values, " or "), is_one ? "s" : "", is_one ? "a " : "", is_one ? "" : "s", is_one ? "s" : "",
      fill.others.low - margin, fill.others.high + margin);
}

}  // namespace tessera::scene
