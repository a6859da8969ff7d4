// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/integrate_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrals/integrate_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "integrals/integrate_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {

template <TableForm form>
HWY_NOINLINE void integrate_batch(const LaneTable& table, FloatBatch& batch) {
  const DF d;
  const Lookup<form> lookup(table);
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < batch.size; i += lanes) {
    const Light light = integrate_lanes(lookup, LoadU(d, &batch.length[i]), LoadU(d, &batch.scalar_front[i]),
                                        LoadU(d, &batch.scalar_back[i]), FirstN(d, batch.size - i));
    StoreU(light.alpha, d, &batch.alpha[i]);
    StoreU(light.optical_depth, d, &batch.optical_depth[i]);
    StoreU(light.red, d, &batch.red[i]);
    StoreU(light.green, d, &batch.green[i]);
    StoreU(light.blue, d, &batch.blue[i]);
  }
}

void integrate_on_lanes(const LaneTable& table, FloatBatch& batch) {
  switch (form_of(table)) {
    case TableForm::one_vector:
      return integrate_batch<TableForm::one_vector>(table, batch);
    case TableForm::two_vectors:
      return integrate_batch<TableForm::two_vectors>(table, batch);
    case TableForm::many:
      return integrate_batch<TableForm::many>(table, batch);
  }
}

const char* form_on_lanes(const LaneTable& table) {
  switch (form_of(table)) {
    case TableForm::one_vector:
      return "one vector";
    case TableForm::two_vectors:
      return "two vectors";
    case TableForm::many:
      break;
  }
  return "many";
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::integrals {
HWY_EXPORT(integrate_on_lanes);
HWY_EXPORT(form_on_lanes);
void integrate_lanes(const LaneTable& table, FloatBatch& batch) {
  HWY_DYNAMIC_DISPATCH(integrate_on_lanes)(table, batch);
}
const char* lane_table_form(const LaneTable& table) { return HWY_DYNAMIC_DISPATCH(form_on_lanes)(table); }
}  // namespace tessera::integrals
#endif  // HWY_ONCE
