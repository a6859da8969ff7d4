#include "apps/progress.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace tessera::apps {
namespace {

constexpr const char* erase_line = "\r\x1b[K";

}  // namespace

Progress::Progress(bool shown, std::size_t frames)
    : shown_(shown && frames > 1), frames_(frames), start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() { clear(); }

void Progress::update(std::size_t done, std::size_t rendered) {
  if (!shown_) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double left = rendered > 0 ? seconds / static_cast<double>(rendered) * static_cast<double>(frames_ - done) : 0;
  fmt::print(stderr, "{}frame {} of {}, {:.1f} s, {:.0f} s left", erase_line, done, frames_, seconds, left);
  std::fflush(stderr);
}

void Progress::clear() {
  if (!shown_) return;
  fmt::print(stderr, "{}", erase_line);
  std::fflush(stderr);
}

}  // namespace tessera::apps
