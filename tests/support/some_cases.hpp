// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::test {

/// Which cases of a long test are executed: all of them; in quick builds (TESSERA_QUICK), which have sanitizers or are
/// not optimized and take ten times as long, the first of every `of`. Cases differ in numbers, and hardly in their
/// memory accesses.
class SomeCases {
 public:
#ifdef TESSERA_QUICK
  explicit SomeCases(int of) : of_(of) {}
#else
  explicit SomeCases(int) {}
#endif

  /// Whether the next case is executed.
  bool next() { return count_++ % of_ == 0; }

 private:
  int of_ = 1;
  int count_ = 0;
};

}  // namespace tessera::test
