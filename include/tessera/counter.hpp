// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tessera {
inline namespace v0_1 {

/// A row of a table of counters: the counter's name in reports, how the values of several processes are combined, and
/// what is counted. Sums, messages between processes and reports loop over these tables, so a new counter requires only
/// a member and a row.
template <class Counters, class Number = std::uint64_t>
struct Counter {
  enum class Together { sum, largest };
  std::string_view name;
  Number Counters::*member;
  Together together;
  bool if_any;  ///< reports omit the counter if it is 0
  std::string_view meaning;
};

/// Adds `others` to `sums`. Each counter is combined as its row of the table states.
template <class Row, std::size_t count, class Counters>
void add_counters(const std::array<Row, count>& table, const Counters& others, Counters& sums) {
  for (const Row& row : table) {
    const auto mine = sums.*row.member, theirs = others.*row.member;
    sums.*row.member = row.together == Row::Together::sum ? mine + theirs : std::max(mine, theirs);
  }
}

}  // namespace v0_1
}  // namespace tessera
