// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tessera/program/printable.hpp"

namespace tessera::apps {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* erase_line = "\r\x1b[K";

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// State of the last line of the terminal. The object is never destroyed, because a signal may arrive while the process
/// ends.
struct LastLine {
  std::timed_mutex mutex;
  bool is_taken = false;
};

LastLine& last_line() {
  static auto* const line = new LastLine;
  return *line;
}

/// Shortens text to one row of the terminal, since a wrapped line could not be erased, and makes it printable, since
/// file names may contain any characters.
std::string one_row(std::string words) {
  words = printable(words);
  winsize size{};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  const std::size_t most = is_known ? size.ws_col - 1u : 79u;
  if (words.size() <= most) return words;
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xc0) == 0x80) --end;  // keeps UTF-8 characters whole
  return words.substr(0, end);
}

/// Erases the line. The caller must hold the lock.
void erase() {
  if (last_line().is_taken) fmt::print(stderr, "{}", erase_line);
  std::fflush(stderr);
  last_line().is_taken = false;
}

}  // namespace

StatusLine::StatusLine(bool shown, std::size_t frames)
    : frames_(frames), run_start_(Clock::now()), stage_start_(run_start_) {
  if (shown) thread_ = std::thread([this] { show_until_stopped(); });
}

StatusLine::~StatusLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_one();
  thread_.join();
  const std::lock_guard lock(last_line().mutex);
  erase();
}

void StatusLine::begin(const std::string& stage) {
  if (!shown()) return;
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  stage_start_ = Clock::now();
  reading_.reset();
  done_.reset();
  if (frames_ > 1 && frames_done_ > 0) return;  // in a film, the line remains between stages
  const std::lock_guard line(last_line().mutex);
  erase();
}

void StatusLine::advance(double done) {
  const std::lock_guard lock(mutex_);
  done_ = done;
}

ReadProgressFunction StatusLine::listener() {
  if (!shown()) return nullptr;
  return [this](const ReadProgress& progress) {
    const std::lock_guard lock(mutex_);
    reading_ = progress;
  };
}

void StatusLine::finish_frames(std::size_t done, std::size_t rendered) {
  if (!shown() || frames_ < 2) return;
  const std::lock_guard lock(mutex_);
  frames_done_ = done, frames_rendered_ = rendered;
  draw(true);
}

std::unique_lock<std::timed_mutex> StatusLine::away() {
  std::unique_lock lock(last_line().mutex);
  erase();
  return lock;
}

void StatusLine::end_all() {
  std::unique_lock lock(last_line().mutex, std::chrono::seconds(1));
  if (!lock.owns_lock()) return;  // the terminal is stopped
  erase();
  static_cast<void>(lock.release());  // nothing is drawn from now on
}

void StatusLine::show_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, std::chrono::milliseconds(250), [this] { return stop_; })) draw(false);
}

void StatusLine::draw(bool soon) {
  const double seconds = seconds_since(stage_start_), all = seconds_since(run_start_);
  const bool is_slow = !stage_.empty() && seconds >= 1;
  if (!is_slow && !soon && frames_done_ == 0) return;
  std::string words = !is_slow   ? ""
                      : reading_ ? reading_words(stage_, reading_, seconds)
                                 : stage_words(stage_, done_, seconds);
  if (frames_done_ > 0) {
    const double each = frames_rendered_ > 0 ? all / static_cast<double>(frames_rendered_) : 0;
    words = fmt::format("frame {} of {}, {:.1f} s, {:.0f} s left{}{}", frames_done_, frames_, all,
                        each * static_cast<double>(frames_ - frames_done_), words.empty() ? "" : "; ", words);
  }
  const std::lock_guard line(last_line().mutex);
  fmt::print(stderr, "{}{}", erase_line, one_row(std::move(words)));
  std::fflush(stderr);
  last_line().is_taken = true;
}

void FrameProgress::tile(const Tile& tile) {
  finished_ += 1.0 * tile.rect.width() * tile.rect.height();
  line_.advance(finished_ / pixels_);
}

Dataset open_watched(const InputFile& file, ReadOptions options, StatusLine& line) {
  line.begin("reading " + file.path().filename().string());
  options.progress = line.listener();
  return Dataset::open(file, options);
}

bool shows_progress(bool quiet) { return !quiet && isatty(STDERR_FILENO) == 1; }

std::string reading_words(const std::string& stage, const std::optional<ReadProgress>& progress, double seconds) {
  if (progress && progress->stage == ReadProgress::Stage::filling)
    return stage + fmt::format(": filling it with tets, {:.0f} s{}", seconds,
                               progress->expected_seconds >= 2 && seconds < progress->expected_seconds
                                   ? fmt::format(" of about {:.0f}", progress->expected_seconds)
                                   : "");
  std::string words = stage;
  if (progress && progress->stage == ReadProgress::Stage::copying)
    words += progress->done < 1
                 ? fmt::format(": {:.0f} % of its points and cells copied", std::floor(100 * progress->done))
                 : std::string(": making tets of its cells");
  else if (progress && progress->done > 0) {  // some libraries report 0 until the end
    return stage_words(stage, progress->done, seconds);
  }
  return words + fmt::format(", {:.0f} s", seconds);
}

std::string stage_words(const std::string& stage, std::optional<double> done, double seconds) {
  std::string words = stage;
  if (done && *done > 0) words += fmt::format(": {:.0f} %", std::floor(100 * std::min(*done, 1.0)));
  words += fmt::format(", {:.0f} s", seconds);
  // The remaining time is shown after a tenth of the work; before, the estimate is unreliable.
  if (done && *done >= 0.1 && *done < 1) words += fmt::format(", {:.0f} s left", seconds / *done * (1 - *done));
  return words;
}

}  // namespace tessera::apps
