#include "exchange/instruction_sets.hpp"

#include <hwy/targets.h>

#include "exchange/wire.hpp"

namespace tessera::exchange {

void agree_instruction_sets(Transport& transport) {
  Bytes mine;
  const std::int64_t supported = hwy::SupportedTargets();
  append(mine, supported);
  std::int64_t common = supported;
  for (const Bytes& of_rank : gather_all(transport, std::move(mine)))
    common &= RecordReader(of_rank).take<std::int64_t>();
  if (common == supported) return;
  hwy::DisableTargets(~common);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace tessera::exchange
