// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "io/foreign/messages/array_source.hpp"
#include "io/foreign/messages/foreign_data.hpp"
#include "io/foreign/messages/helper_messages.hpp"
#include "scene/error.hpp"
#include "tessera/read_progress.hpp"

namespace tessera::io {

/// Memory filled by the helper: mapped from an unnamed file, with contents that do not change during the lifetime of
/// this object.
class SharedBytes {
 public:
  SharedBytes() = default;
  /// Throws std::bad_alloc if `file` cannot be mapped, std::invalid_argument unless it contains `count` bytes.
  SharedBytes(const system::Descriptor& file, std::uint64_t count);
  /// Creates memory that another process can fill and modify, but not shrink, through `file`.
  static SharedBytes made(std::size_t count, system::Descriptor& file);
  ~SharedBytes();
  SharedBytes(SharedBytes&& other) noexcept;
  SharedBytes& operator=(SharedBytes&& other) noexcept;

  [[nodiscard]] std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(start_), size_}; }
  /// Returns the bytes as numbers of type T. Remaining bytes that are too few for a number are omitted.
  template <class T>
  [[nodiscard]] std::span<const T> as() const {
    return {static_cast<const T*>(start_), size_ / sizeof(T)};
  }

 private:
  void* start_ = nullptr;
  std::size_t size_ = 0;
};

/// The purpose of a helper: which program it is, and the words of the error that is reported if the helper dies ("FILE:
/// WORDS crashed (...); REMEDY").
struct HelperTask {
  std::string words = "reading it", remedy = "write the file again, or in another format";
  Reader reader = Reader::vtk;
  const Format* format = nullptr;   ///< format of the files, named in the error if the program is not installed
  ReadProgressFunction progress{};  ///< called with the progress; may be null
  std::string limit_remedy{};       ///< remedy to report if the helper takes too long; empty: the usual remedy
  /// How long the helper may wait, without using processor time, for anything but the caller, for example for a pipe.
  std::chrono::milliseconds patience = std::chrono::minutes(2);
};

/// Why a helper died. The words do not contain the subject of the sentence.
struct HelperDeath {
  scene::ErrorCode code;
  std::string words;
};

/// A running helper program (readers/README.md): a separate process in which third-party readers, and TetGen, may
/// crash, print and allocate memory. The helper ends with this object.
///
/// Found    by find_reader(). The first call() throws missing_reader() with its subject if the program is not
/// installed. Started  by posix_spawn, so nothing of the caller's process is copied. The helper inherits no file and no
/// variable
///          that MPI launchers set; its output is discarded.
/// Limits   on memory and processor time are computed from the sizes of the files that the helper opens or the surface
///          that it fills. The helper sets them itself when it gives up the right to change anything
///          (readers/common/sandbox.hpp). A helper that waits longer than HelperTask::patience is killed.
/// Threads  calls from several threads are executed one after the other.
class HelperProcess final : public ArraySource {
 public:
  /// Throws Error(system_failure) if the program is installed but cannot be started.
  explicit HelperProcess(HelperTask task = {});
  ~HelperProcess() override;
  HelperProcess(const HelperProcess&) = delete;
  HelperProcess& operator=(const HelperProcess&) = delete;

  /// Sends a request and waits for the reply. Throws the helper's own error, or Error(bad_input, "SUBJECT: ...") if the
  /// helper has died; all later calls then throw the same error.
  nlohmann::json call(const nlohmann::json& request, const std::string& subject);

  /// Fetches an array from the helper, which then discards the array unless `keep` is set. Throws like call().
  SharedBytes take(const ForeignArray& array, const std::string& subject, bool keep = false);

  /// Implements ArraySource::stream(); the helper prepares the next tuples in parallel. Faster than take(), for which
  /// the helper creates a file of small pages.
  using ArraySource::stream;
  void stream(const ForeignArray& array, const std::string& subject,
              const std::function<void(std::span<const std::byte> tuples)>& use, Then then) override;

  void expect(std::uint64_t bytes) override { expected_ = bytes, received_ = 0; }
  void drop(std::span<const std::uint64_t> arrays) noexcept override;

  /// Process id of the helper, for tests; -1 once the helper has died.
  [[nodiscard]] int process() const { return process_; }

 private:
  HelperMessage exchange(const nlohmann::json& request, const std::string& subject);
  void send(const nlohmann::json& request, const std::string& subject, int file = -1);
  HelperMessage receive(const std::string& subject);
  /// Waits for the next message. No value if the helper has ended, or was killed because it waited too long.
  std::optional<HelperMessage> await();
  void open_window(const std::string& subject);
  /// Must be called before waiting for the helper's end: after the end, the process id may belong to another process.
  void forget() const;
  [[noreturn]] void report_death(const std::string& subject);

  HelperTask task_;
  std::mutex mutex_;
  int process_ = -1;
  system::Descriptor socket_;
  SharedBytes window_;                         ///< slots for stream(); empty until first used
  std::uint64_t expected_ = 0, received_ = 0;  ///< bytes that stream() will pass, and has passed
  bool has_begun_ = false;                     ///< the helper's first message has arrived
  bool waits_ = false;                         ///< the helper was killed because it waited too long
  std::string reading_;                        ///< which of several files the helper is reading; empty: not reported
                                               ///< yet
  std::optional<HelperDeath> death_;           ///< set once the helper is dead
};

}  // namespace tessera::io
