// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/method_words.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace tessera {
inline namespace v0_1 {

const char* exchange_word(Exchange exchange) { return exchange == Exchange::runs ? "runs" : "segments"; }

const char* method_word(IntegratorKind kind) {
  constexpr std::array words = {"exact", "sampled", "preintegrated", "partial", "auto"};
  return words[static_cast<std::size_t>(kind)];
}

std::string method_line(const Integrator& integrator) {
  std::string word = method_word(integrator.kind);
  if (integrator.kind == IntegratorKind::sampled) return fmt::format("{}:{}", word, integrator.samples);
  if (integrator.kind == IntegratorKind::preintegrated) return fmt::format("{}:{}", word, integrator.table_size);
  if (integrator.kind == IntegratorKind::automatic) return fmt::format("{} to {:g}", word, integrator.accuracy);
  return word;
}

bool takes_steps(const Integrator& integrator) {
  return integrator.kind == IntegratorKind::sampled || integrator.kind == IntegratorKind::preintegrated;
}

}  // namespace v0_1
}  // namespace tessera
