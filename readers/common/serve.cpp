// SPDX-License-Identifier: BSD-3-Clause
#include "readers/common/serve.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "io/files/input_file.hpp"
#include "io/foreign/messages/helper_messages.hpp"
#include "io/text/clean_errors.hpp"
#include "readers/common/opened_files.hpp"
#include "readers/common/readers.hpp"
#include "readers/common/sandbox.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

using Json = nlohmann::json;

constexpr int socket_to_caller = 3;

Json open(std::span<const Reader> readers, Holdings& holdings, const Json& request) {
  const auto file = request.at("file").get<std::string>();
  if (const int version = request.at("version").get<int>(); version != io::helper_version)
    throw scene::Error(scene::ErrorCode::system_failure, "the helper program",
                       fmt::format("its version, {}, differs from the library's, {}", io::helper_version, version),
                       "install both again");
  const auto name = request.at("reader").get<std::string>();
  for (const Reader& reader : readers)
    if (name == reader.name) return {{"contents", Json::binary(io::bytes_of(reader.read(holdings, file, request)))}};
  throw scene::Error(scene::ErrorCode::system_failure, "the helper program",
                     fmt::format("it was built without {}", name), "install the one that belongs to the library");
}

/// Creates an unnamed file with the numbers of an array.
system::Descriptor file_of(const Holdings::Held& held) {
  system::Descriptor file(::memfd_create("tessera", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file.is_open()) throw std::bad_alloc();
  constexpr std::size_t some_bytes = 1 << 18;  // small enough for the processor's cache
  const std::size_t tuple = held.array.tuple_bytes();
  const std::uint64_t at_once = std::max<std::uint64_t>(some_bytes / tuple, 1);
  std::vector<std::byte> some(std::min(at_once, held.array.tuples) * tuple);
  for (std::uint64_t first = 0; first < held.array.tuples; first += at_once) {
    const std::uint64_t count = std::min(at_once, held.array.tuples - first);
    held.read(first, count, some.data());
    if (!system::write_all(file.get(), some.data(), count * tuple)) throw std::bad_alloc();
  }
  return file;
}

/// Memory of the caller, divided into slots. Arrays are transferred through it without a file for each.
class Window {
 public:
  void open(const system::Descriptor& file, std::size_t slot) {
    struct stat facts {};
    if (!file.is_open() || slot == 0 || ::fstat(file.get(), &facts) != 0) throw std::invalid_argument("no window");
    const auto bytes = static_cast<std::size_t>(facts.st_size);
    void* const start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
    if (start == MAP_FAILED) throw std::bad_alloc();
    slots_ = std::span(static_cast<std::byte*>(start), bytes);
    slot_ = slot;
  }

  void put(const Holdings::Held& held, std::uint64_t first, std::uint64_t count, std::size_t slot) {
    if (first > held.array.tuples || count > held.array.tuples - first || count > slot_ / held.array.tuple_bytes() ||
        slot >= slots_.size() / slot_)
      throw std::invalid_argument("these tuples do not exist or do not fit");
    held.read(first, count, slots_.data() + slot * slot_);
  }

 private:
  std::span<std::byte> slots_;
  std::size_t slot_ = 1;
};

/// Ends this process when its caller ends. A thread waits until the caller's end of the socket closes, which happens
/// however the caller ends. PR_SET_PDEATHSIG is not used, because it is sent when the thread that started this process
/// ends, even if the process of that thread continues.
void end_with_caller() {
  pollfd caller{.fd = socket_to_caller, .events = POLLRDHUP, .revents = 0};
  while (::poll(&caller, 1, -1) < 0 && errno == EINTR) {
  }
  ::_exit(0);
}

Json error_json(const scene::Error& error) {
  return {{"error", {{"line", error.what()}, {"code", static_cast<int>(error.code())}}}};
}

/// Answers one request. Returns false if the caller has ended.
bool answer(std::span<const Reader> readers, Holdings& holdings, Window& window, const Json& request,
            const system::Descriptor& given) {
  const auto asked = request.at("do").get<std::string>();
  if (asked == "drop") {
    for (const Json& array : request.at("arrays")) holdings.drop(array.get<std::uint64_t>());
    return true;
  }
  const std::string source = request.value("file", std::string("the file"));
  Json reply = Json::object();
  system::Descriptor file;
  try {
    if (asked == "open") {
      reply = open(readers, holdings, request);
    } else if (asked == "window") {
      window.open(given, request.at("slot").get<std::size_t>());
    } else if (asked == "put") {
      const Holdings::Held* const held = holdings.find(request.at("array").get<std::uint64_t>());
      if (held == nullptr) throw std::invalid_argument("no such array");
      window.put(*held, request.at("first").get<std::uint64_t>(), request.at("count").get<std::uint64_t>(),
                 request.at("slot").get<std::size_t>());
    } else {
      const auto number = request.at("array").get<std::uint64_t>();
      if (const Holdings::Held* held = holdings.find(number)) file = file_of(*held);
      if (!request.at("keep").get<bool>()) holdings.drop(number);
    }
  } catch (const scene::Error& error) {
    reply = error_json(error);
  } catch (const std::bad_alloc&) {
    reply = error_json(memory_error(source));
  } catch (const std::exception&) {
    reply = error_json(
        scene::bad_input(fmt::format("{}: it cannot be read; write the file again, or in another format", source)));
  }
  const auto add = [&](const char* key, const std::vector<std::string>& names) {
    for (const std::string& name : names)
      reply[key].push_back(Json::binary(std::vector<std::uint8_t>(name.begin(), name.end())));
  };
  add("opened", take_opened_files());
  add("named", take_named_files());
  return io::send_message(socket_to_caller, Json::to_cbor(reply), file.get());
}

}  // namespace

void report_progress(double done) {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point last{};  // the first report is sent at once
  if (const Clock::time_point now = Clock::now(); now - last >= std::chrono::milliseconds(100)) {
    last = now;
    static_cast<void>(
        io::send_message(socket_to_caller, Json::to_cbor({{"progress", done}})));  // fails if the caller has ended,
                                                                                   // which does not matter
  }
}

void report_reading(const std::filesystem::path& file) {
  const std::string name = file.string();
  static_cast<void>(io::send_message(
      socket_to_caller,
      Json::to_cbor({{"reading", Json::binary(std::vector<std::uint8_t>(name.begin(), name.end()))}})));
}

void serve(std::span<const Reader> readers, MayFork may_fork) {
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  give_up_rights(may_fork);
  try {
    std::thread(end_with_caller).detach();
  } catch (const std::system_error&) {  // if the thread cannot be created, the process ends after the current request
  }
  Holdings holdings;
  Window window;
  if (!io::send_message(socket_to_caller, Json::to_cbor(Json::object()))) ::_exit(0);
  while (const std::optional<io::HelperMessage> message = io::receive_message(socket_to_caller))
    if (!answer(readers, holdings, window, Json::from_cbor(message->bytes), message->file)) break;
  ::_exit(0);  // skips destructors, because damaged files may have corrupted memory
}

}  // namespace tessera::readers
