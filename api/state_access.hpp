// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"
#include "tessera/input_file.hpp"

namespace tessera {
inline namespace v0_1 {

/// Gives the library access to the state of its public classes. No installed header defines this structure.
struct StateAccess {
  static const Communicator::State& of(const Communicator& communicator) { return *communicator.state_; }
  static const Dataset::State& of(const Dataset& dataset) { return *dataset.state_; }
  static const InputFile::Found& of(const InputFile& file) { return *file.found_; }
  static Communicator make(std::shared_ptr<const Communicator::State> state) { return Communicator(std::move(state)); }
  static Dataset make(std::shared_ptr<const Dataset::State> state) { return Dataset(std::move(state)); }
};

}  // namespace v0_1
}  // namespace tessera
