// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/instruction_sets.hpp"

#include <hwy/targets.h>

#include "exchange/collectives.hpp"

namespace tessera::exchange {

void agree_instruction_sets(Transport& transport) {
  const std::int64_t supported = hwy::SupportedTargets();
  std::int64_t common = supported;
  for (const std::int64_t of_rank : gather_values(transport, MessageKind::instruction_sets, supported))
    common &= of_rank;
  if (common == supported) return;
  hwy::DisableTargets(~common);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace tessera::exchange
