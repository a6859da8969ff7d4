// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "api/options/argument_values.hpp"
#include "api/options/choices.hpp"
#include "api/options/setting_name.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"

namespace tessera::api {
namespace {

/// Sets how a volume's image is split between ranks.
void set_balance(const OptionWords& words, RankSettings& ranks) {
  assign(ranks.distribution, words.choice("distribution", distributions));
  assign(ranks.direct_send, words.choice("direct-send", direct_sends));
  const bool sorts_last = ranks.distribution == Distribution::sort_last;
  if (!sorts_last && words.given("direct-send"))
    throw bad_input("`direct_send`: it has no effect without `distribution` sort-last; add that, or leave it out");
  for (const char* option : {"balance", "balance-resolution", "balance-weights"})
    if (sorts_last && words.given(option))
      throw bad_input(fmt::format(
          "{}: it has no effect with `distribution` sort-last, which splits the volume; leave one of the two out",
          setting_name(option)));
  assign(ranks.balance, words.choice("balance", balances));
  assign(ranks.balance_resolution, words.positive("balance-resolution"));
  if (ranks.balance_resolution > 1 || ranks.balance_resolution < 1e-3)
    throw bad_input(fmt::format("`balance_resolution`: {} is not from 0.001 to 1", words.word("balance-resolution")));
  const std::string& weights = words.word("balance-weights");
  ranks.balance_measured = weights == "measured";
  if (!weights.empty() && !ranks.balance_measured)
    for (const std::string& weight : split_at_commas(weights))
      ranks.balance_weights.push_back(parse_positive("`balance_weights`", weight));
}

}  // namespace

void set_ranks(const OptionWords& words, RenderOptions& options) {
  RankSettings& ranks = options.settings.ranks;
  options.settings.mesh.device = device_settings(words, options.is_grid());
  options.show_balance = options.frame.keep_cost = words.choice("show").has_value();
  set_balance(words, ranks);
  ranks.projectors = words.count("projectors", 1);
  ranks.compositors = words.count("compositors", 1);
  ranks.exchange = words.choice("exchange", exchanges);
  if (!parse_without("`without`", words.word("without")).merging) {
    if (ranks.exchange == Exchange::runs)
      throw bad_input(
          "`without` merging: it implies `exchange` segments, but runs were requested; leave one of the two out");
    ranks.exchange = Exchange::segments;
  }
  assign(ranks.partition.kind, words.choice("partition", partition_kinds));
  assign(ranks.frames_in_flight, words.count("frames-in-flight", 1, 64));
  const auto seed = words.count("seed", 0);
  assign(ranks.tile_seed, seed);
  assign(ranks.partition.seed, seed);
}

}  // namespace tessera::api
