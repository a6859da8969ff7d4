// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/masked_lanes.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrals/masked_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "integrals/integrate_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {

template <TableForm form>
void masked_of_form(const LaneTable& table, FloatBatch& batch) {
  const DF d;
  const DI di;
  const Lookup<form> lookup(table);
  const VI odd = And(Iota(di, 0), Set(di, 1));
  const VF nan = Set(d, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(d))
    for (const int parity : {0, 1}) {
      const MF active = And(FirstN(d, batch.size - i), RebindMask(d, odd == Set(di, parity)));
      const auto input = [&](const std::vector<float>& a) HWY_ATTR { return IfThenElse(active, LoadU(d, &a[i]), nan); };
      const Light light =
          integrate_lanes(lookup, input(batch.length), input(batch.scalar_front), input(batch.scalar_back), active);
      const auto add = [&](std::vector<float>& a, VF x) HWY_ATTR { StoreU(LoadU(d, &a[i]) + x, d, &a[i]); };
      add(batch.alpha, light.alpha);
      add(batch.optical_depth, light.optical_depth);
      add(batch.red, light.red);
      add(batch.green, light.green);
      add(batch.blue, light.blue);
    }
}

void masked_on_lanes(const LaneTable& table, FloatBatch& batch) {
  switch (form_of(table)) {
    case TableForm::one_vector:
      return masked_of_form<TableForm::one_vector>(table, batch);
    case TableForm::two_vectors:
      return masked_of_form<TableForm::two_vectors>(table, batch);
    case TableForm::many:
      return masked_of_form<TableForm::many>(table, batch);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::integrals {
HWY_EXPORT(masked_on_lanes);
}
namespace tessera::tests {
void integrate_masked_lanes(const integrals::LaneTable& table, integrals::FloatBatch& batch) {
  using namespace integrals;
  HWY_DYNAMIC_DISPATCH(masked_on_lanes)(table, batch);
}
}  // namespace tessera::tests
#endif  // HWY_ONCE
