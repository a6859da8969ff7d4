#include "apps/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
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

ReadingLine::ReadingLine(bool shown, const std::filesystem::path& file)
    : file_(file.filename().string()), start_(std::chrono::steady_clock::now()) {
  if (shown) thread_ = std::thread([this] { show_until_stopped(); });
}

ReadingLine::~ReadingLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_one();
  thread_.join();
}

ReadProgressFunction ReadingLine::listener() {
  if (!thread_.joinable()) return nullptr;
  return [this](const ReadProgress& progress) {
    const std::lock_guard lock(mutex_);
    progress_ = progress;
  };
}

void ReadingLine::show_until_stopped() {
  constexpr std::chrono::milliseconds before = std::chrono::seconds(1), between{250};
  std::unique_lock lock(mutex_);
  bool is_there = false;
  while (!stopped_.wait_for(lock, is_there ? between : before, [this] { return stop_; })) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    fmt::print(stderr, "{}{}", erase_line, reading_words(file_, progress_, seconds));
    std::fflush(stderr);
    is_there = true;
  }
  if (is_there) fmt::print(stderr, "{}", erase_line);
  std::fflush(stderr);
}

Dataset open_watched(const std::filesystem::path& file, ReadOptions options, bool quiet) {
  ReadingLine line(!quiet && isatty(STDERR_FILENO) == 1, file);
  options.progress = line.listener();
  return Dataset::open(file, options);
}

std::string reading_words(const std::string& file, const std::optional<ReadProgress>& progress, double seconds) {
  std::string words = fmt::format("reading {}", file);
  if (progress && progress->stage == ReadProgress::Stage::copying)
    words += progress->done < 1
                 ? fmt::format(": {:.0f} % of its points and cells copied", std::floor(100 * progress->done))
                 : std::string(": making tets of its cells");
  else if (progress && progress->done > 0)  // some libraries say 0 for as long as they read
    words += fmt::format(": {:.0f} %", std::floor(100 * progress->done));
  return words + fmt::format(", {:.0f} s", seconds);
}

}  // namespace tessera::apps
