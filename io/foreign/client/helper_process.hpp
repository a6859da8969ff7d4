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

/// Memory that the helper has filled: mapped from a file without a name, the same bytes for as long as this lives.
class SharedBytes {
 public:
  SharedBytes() = default;
  /// Throws std::bad_alloc if it cannot be mapped, std::invalid_argument unless it holds `count` bytes.
  SharedBytes(const system::Descriptor& file, std::uint64_t count);
  /// Memory that another process may fill and change, and not shrink, by `file`.
  static SharedBytes made(std::size_t count, system::Descriptor& file);
  ~SharedBytes();
  SharedBytes(SharedBytes&& other) noexcept;
  SharedBytes& operator=(SharedBytes&& other) noexcept;

  [[nodiscard]] std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(start_), size_}; }
  /// As numbers, of which there are as many as fit.
  template <class T>
  [[nodiscard]] std::span<const T> as() const {
    return {static_cast<const T*>(start_), size_ / sizeof(T)};
  }

 private:
  void* start_ = nullptr;
  std::size_t size_ = 0;
};

/// What a helper is for, in the words of the error that its death becomes: "FILE: WORDS crashed (...); REMEDY". And
/// which of the programs it is.
struct HelperTask {
  std::string words = "reading it", remedy = "have it written again, or in another format";
  Reader reader = Reader::vtk;
  const Format* format = nullptr;   ///< of the files, to be named if the program is not installed
  ReadProgressFunction progress{};  ///< hears how far it is; null: nobody
  std::string limit_remedy{};       ///< where it takes too long; empty: as ever
  /// For how long it may wait for something else than the caller, without any processor time: for a pipe, say.
  std::chrono::milliseconds patience = std::chrono::minutes(2);
};

/// What a helper died of, without the subject.
struct HelperDeath {
  scene::ErrorCode code;
  std::string words;
};

/// A running helper program (readers/README.md): a process of its own in which other people's readers, and TetGen, may
/// crash, print and ask for memory. It ends with this object.
///
/// Found    by find_reader(). The first call() throws missing_reader() of its subject if it is not installed.
/// Started  by posix_spawn: nothing of the caller's process is copied. It inherits no file and, of the environment,
///          nothing that MPI launchers set; what it prints goes nowhere.
/// Limits   of memory and processor time, by the sizes of the files it opens or the surface it fills, which it sets
///          itself, as it gives up the right to change anything (readers/common/sandbox.hpp). One that waits for longer
///          than HelperTask::patience is ended.
/// Threads  calls wait for each other.
class HelperProcess final : public ArraySource {
 public:
  /// Throws Error(system_failure) if it is installed and cannot be started.
  explicit HelperProcess(HelperTask task = {});
  ~HelperProcess() override;
  HelperProcess(const HelperProcess&) = delete;
  HelperProcess& operator=(const HelperProcess&) = delete;

  /// Sends a request and waits. Throws the helper's own error, or Error(bad_input, "SUBJECT: ...") if it died of it;
  /// then every later call throws that too.
  nlohmann::json call(const nlohmann::json& request, const std::string& subject);

  /// The helper's array, which it then has no more, unless it is to `keep` it. Throws as call().
  SharedBytes take(const ForeignArray& array, const std::string& subject, bool keep = false);

  /// ArraySource's, while the helper prepares the next tuples. Faster than take(), which makes a file of small pages.
  using ArraySource::stream;
  void stream(const ForeignArray& array, const std::string& subject,
              const std::function<void(std::span<const std::byte> tuples)>& use, Then then) override;

  void expect(std::uint64_t bytes) override { expected_ = bytes, came_ = 0; }
  void drop(std::span<const std::uint64_t> arrays) noexcept override;

  /// Its process, for tests; -1 once it has died.
  [[nodiscard]] int process() const { return process_; }

 private:
  HelperMessage exchange(const nlohmann::json& request, const std::string& subject);
  void send(const nlohmann::json& request, const std::string& subject, int file = -1);
  HelperMessage receive(const std::string& subject);
  /// Nothing if it is gone, or is ended for waiting too long.
  std::optional<HelperMessage> await();
  void open_window(const std::string& subject);
  /// Before its end is waited for, after which its number may be another's.
  void forget() const;
  [[noreturn]] void report_death(const std::string& subject);

  HelperTask task_;
  std::mutex mutex_;
  int process_ = -1;
  system::Descriptor socket_;
  SharedBytes window_;                     ///< of slots for stream(); empty until it is needed
  std::uint64_t expected_ = 0, came_ = 0;  ///< bytes of stream()
  bool has_begun_ = false;                 ///< it has said that it is there
  bool waits_ = false;                     ///< it was ended for that
  std::string reading_;                    ///< the file that it is at, of several; empty: it has not said
  std::optional<HelperDeath> death_;       ///< once it is dead
};

}  // namespace tessera::io
