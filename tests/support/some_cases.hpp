#pragma once

namespace tessera::test {

/// Which cases of a long test are tried: all of them; in the quick sanitized build (TESSERA_QUICK_SANITIZE), where each takes
/// ten times as long, the first of every `of`. They differ in numbers and hardly in the memory that they touch.
class SomeCases {
 public:
#ifdef TESSERA_QUICK_TESTS
  explicit SomeCases(int of) : of_(of) {}
#else
  explicit SomeCases(int) {}
#endif

  /// Whether the next case is tried.
  bool next() { return count_++ % of_ == 0; }

 private:
  int of_ = 1;
  int count_ = 0;
};

}  // namespace tessera::test
