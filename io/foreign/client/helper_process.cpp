// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/client/helper_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "io/files/input_file.hpp"
#include "scene/error.hpp"
#include "system/files_read.hpp"
#include "system/idle_watch.hpp"
#include "system/spawn_plan.hpp"
#include "system/unfinished.hpp"

namespace tessera::io {
namespace {

using Json = nlohmann::json;

/// Slots of the window. One slot is read while the other is filled; both fit into the processor's cache.
constexpr std::size_t slots = 2, slot_bytes = 2 << 20;

bool is_picture(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 7> extensions = {".png", ".exr", ".jpg", ".jpeg", ".tif", ".tiff", ".pfm"};
  return std::ranges::find(extensions, system::lower_extension(file)) != extensions.end();
}

/// Returns the caller's environment without variables that would make the helper start as an MPI rank.
std::vector<char*> helper_environment() {
  // Makes malloc use large pages (glibc 2.35): readers fill hundreds of megabytes once, and page faults take most of
  // that time.
  static char tunables[] = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";
  std::vector<char*> kept;
  if (::getenv("GLIBC_TUNABLES") == nullptr) kept.push_back(tunables);
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const auto begins = [&](std::string_view prefix) { return text.starts_with(prefix); };
    if (!begins("OMPI_") && !begins("PMIX_") && !begins("PRTE_") && !begins("PMI_") && !begins("HYDRA_"))
      kept.push_back(*entry);
  }
  kept.push_back(nullptr);
  return kept;
}

[[noreturn]] void fail_to_start(Reader reader, const std::string& why) {
  throw scene::Error(scene::ErrorCode::system_failure, reader_program(reader).program, why,
                     "this helper reads the formats of other programs; install it with the library");
}

/// Whether this process may use less memory than the machine has. Its children inherit the limit.
bool is_limited() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/// Describes how a process ended. `status` is the result of waitpid if `known`.
HelperDeath death_of(int status, bool known, bool has_begun, const HelperTask& task) {
  using enum scene::ErrorCode;
  if (!has_begun)
    return {
        system_failure,
        fmt::format("{} cannot start: {} exits as soon as it is started; check that it runs, and give it more memory",
                    task.words, reader_program(task.reader).program)};
  if (!known || !WIFSIGNALED(status)) return {bad_input, fmt::format("{} failed; {}", task.words, task.remedy)};
  switch (WTERMSIG(status)) {
    case SIGXCPU:
      return {bad_input, fmt::format("{} takes much longer than a file of this size should take; {}", task.words,
                                     task.limit_remedy.empty() ? task.remedy : task.limit_remedy)};
    case SIGKILL:
      return {
          system_failure,
          fmt::format("{} was killed from outside, perhaps because memory ran out; use a larger machine", task.words)};
    default:
      break;
  }
  const std::string words = fmt::format("{} crashed ({})", task.words, ::strsignal(WTERMSIG(status)));
  if (is_limited())
    return {system_failure, words + ", perhaps because memory ran out; raise the limit on address space"};
  return {bad_input, fmt::format("{}; {}", words, task.remedy)};
}

HelperDeath waiting_death(const HelperTask& task) {
  return {scene::ErrorCode::bad_input, fmt::format("{} waits for data that do not arrive, perhaps because the file "
                                                   "refers to a pipe; let it refer to regular files only",
                                                   task.words)};
}

/// A message that the helper sends before its reply: the progress, or the file that it is reading.
struct Course {
  std::optional<double> done;
  std::string reading;
};

/// No value if the message is a reply.
std::optional<Course> course_of(std::span<const std::uint8_t> message) {
  constexpr std::size_t longest = 8192;  // a name has at most 4096 bytes
  if (message.size() > longest) return std::nullopt;
  const Json json = Json::from_cbor(message, true, false);
  if (!json.is_object()) return std::nullopt;
  if (const auto done = json.find("progress"); done != json.end() && done->is_number()) {
    const auto number = done->get<double>();
    return Course{number >= 0 ? std::min(number, 1.0) : 0, ""};  // a NaN becomes 0
  }
  if (const auto file = json.find("reading"); file != json.end() && file->is_binary()) {
    const auto& name = file->get_binary();
    return Course{std::nullopt, std::string(name.begin(), name.end())};
  }
  return std::nullopt;
}

}  // namespace

SharedBytes::SharedBytes(const system::Descriptor& file, std::uint64_t count) : size_(static_cast<std::size_t>(count)) {
  struct stat facts {};
  if (!file.is_open() || ::fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) != 0 ||
      ::fstat(file.get(), &facts) != 0 || static_cast<std::uint64_t>(facts.st_size) != count)
    throw std::invalid_argument("an array of another size");
  if (size_ == 0) return;
  void* const start = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED | MAP_POPULATE, file.get(), 0);
  if (start == MAP_FAILED) throw std::bad_alloc();
  start_ = start;
}

SharedBytes SharedBytes::made(std::size_t count, system::Descriptor& file) {
  file = system::Descriptor(::memfd_create("tessera", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file.is_open() || ::ftruncate(file.get(), static_cast<off_t>(count)) != 0 ||
      ::fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
    throw std::bad_alloc();
  SharedBytes made;
  void* const start = ::mmap(nullptr, count, PROT_READ, MAP_SHARED, file.get(), 0);
  if (start == MAP_FAILED) throw std::bad_alloc();
  made.start_ = start;
  made.size_ = count;
  return made;
}

SharedBytes::~SharedBytes() {
  if (start_ != nullptr) ::munmap(start_, size_);
}

SharedBytes::SharedBytes(SharedBytes&& other) noexcept
    : start_(std::exchange(other.start_, nullptr)), size_(std::exchange(other.size_, 0)) {}

SharedBytes& SharedBytes::operator=(SharedBytes&& other) noexcept {
  std::swap(start_, other.start_);
  std::swap(size_, other.size_);
  return *this;
}

HelperProcess::HelperProcess(HelperTask task) : task_(std::move(task)) {
  const std::filesystem::path program = find_reader(task_.reader);
  if (program.empty()) return;
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail_to_start(task_.reader, fmt::format("no socket can be created for it: {}", std::strerror(errno)));
  socket_ = system::Descriptor(ends[0]);
  const system::Descriptor theirs(ends[1]);

  constexpr int helper_end = 3;  // the descriptor that readers/common/serve.cpp uses
  // The caller handles signals that a terminal sends to both processes; the helper ends when the caller ends.
  system::SpawnPlan plan({SIGINT, SIGTERM, SIGHUP, SIGQUIT});
  // Must be the first action: if the caller has closed its standard descriptors, `theirs` may be one of the descriptors
  // that the following actions open.
  ::posix_spawn_file_actions_adddup2(&plan.files, theirs.get(), helper_end);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&plan.files, standard, "/dev/null", O_RDWR, 0);
  ::posix_spawn_file_actions_addclosefrom_np(&plan.files, helper_end + 1);
  // The helper ends when its caller ends or, if it is still loading its libraries then, after loading them.
  pid_t process = -1;
  if (const int error = plan.start(program, {program.string()}, helper_environment().data(), process); error != 0)
    fail_to_start(task_.reader, fmt::format("{} cannot be started: {}", program.string(), std::strerror(error)));
  process_ = process;
}

HelperProcess::~HelperProcess() {
  socket_ = system::Descriptor();  // closing the socket signals the helper to end
  forget();
  while (process_ >= 0 && ::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void HelperProcess::forget() const {
  if (process_ < 0) return;
  const auto lock = system::naming_outputs();
  system::remove_unfinished(process_);
}

void HelperProcess::report_death(const std::string& subject) {
  if (!death_) {
    socket_ = system::Descriptor();
    forget();
    int status = 0;
    pid_t ended = -1;
    while ((ended = ::waitpid(process_, &status, 0)) < 0 && errno == EINTR) {
    }
    death_ = waits_ ? waiting_death(task_) : death_of(status, ended == process_, has_begun_, task_);
    process_ = -1;
  }
  throw scene::Error(death_->code, fmt::format("{}: {}", reading_.empty() ? subject : reading_, death_->words));
}

HelperMessage HelperProcess::exchange(const Json& request, const std::string& subject) {
  const std::lock_guard lock(mutex_);
  send(request, subject);
  return receive(subject);
}

void HelperProcess::send(const Json& request, const std::string& subject, int file) {
  if (death_) report_death(subject);
  if (process_ < 0) throw missing_reader(task_.reader, subject, task_.format);
  if (!has_begun_) has_begun_ = receive_message(socket_.get()).has_value();
  if (!has_begun_ || !send_message(socket_.get(), Json::to_cbor(request), file)) report_death(subject);
}

std::optional<HelperMessage> HelperProcess::await() {
  system::IdleWatch watch(process_);
  pollfd socket{.fd = socket_.get(), .events = POLLIN, .revents = 0};
  const auto step = std::min<std::chrono::milliseconds>(task_.patience / 4, std::chrono::seconds(1));
  for (;;) {
    const int ready = ::poll(&socket, 1, static_cast<int>(step.count()));
    if (ready > 0) return receive_message(socket_.get());
    if (ready == 0 && watch.look() > task_.patience) {
      waits_ = true;
      ::kill(process_, SIGKILL);
      return std::nullopt;
    }
  }
}

HelperMessage HelperProcess::receive(const std::string& subject) {
  for (;;) {
    std::optional<HelperMessage> reply = await();
    if (!reply) report_death(subject);
    std::optional<Course> course = course_of(reply->bytes);
    if (!course) {
      reading_.clear();
      return std::move(*reply);
    }
    if (!course->done)
      reading_ = std::move(course->reading);
    else if (task_.progress)
      task_.progress({ReadProgress::Stage::reading, *course->done});
  }
}

namespace {

/// Returns the contents of a reply. Throws the error that the reply reports.
Json content_of(const HelperMessage& reply, const std::string& subject) {
  Json json;
  std::string line;
  int code = 0;
  try {
    json = Json::from_cbor(reply.bytes);
    const auto note_files = [&](const char* key, auto* note) {
      const auto names = json.find(key);
      if (names == json.end()) return;
      for (const Json& name : *names) {
        const std::filesystem::path file(std::string(name.get_binary().begin(), name.get_binary().end()));
        // Some readers open every file of a directory, including images of earlier runs, which are not inputs.
        if (!is_picture(file)) note(file);
      }
    };
    note_files("opened", &system::note_read);
    note_files("named", &system::note_named);
    if (const auto error = json.find("error"); error != json.end()) {
      line = error->at("line").get<std::string>();
      code = error->at("code").get<int>();
    }
  } catch (const Json::exception&) {
    throw scene::bad_input(
        fmt::format("{}: its reader returned an invalid answer; write the file again, or in another format", subject));
  }
  if (code != 0)
    throw scene::Error(code == static_cast<int>(scene::ErrorCode::system_failure) ? scene::ErrorCode::system_failure
                                                                                  : scene::ErrorCode::bad_input,
                       line);
  return json;
}

}  // namespace

Json HelperProcess::call(const Json& request, const std::string& subject) {
  return content_of(exchange(request, subject), subject);
}

void HelperProcess::open_window(const std::string& subject) {
  system::Descriptor file;
  SharedBytes window = SharedBytes::made(slots * slot_bytes, file);
  send({{"do", "window"}, {"slot", slot_bytes}}, subject, file.get());
  content_of(receive(subject), subject);
  window_ = std::move(window);
}

void HelperProcess::stream(const ForeignArray& array, const std::string& subject,
                           const std::function<void(std::span<const std::byte> tuples)>& use, Then then) {
  const std::size_t tuple = array.tuple_bytes();
  if (tuple > slot_bytes) return use(take(array, subject, then == Then::kept).bytes());
  const std::uint64_t at_once = slot_bytes / tuple, parts = (array.tuples + at_once - 1) / at_once;
  const auto count_of = [&](std::uint64_t part) { return std::min(at_once, array.tuples - part * at_once); };
  {
    const std::lock_guard lock(mutex_);
    if (window_.bytes().empty()) open_window(subject);
    std::uint64_t asked = 0, came = 0;
    const auto ask = [&] {
      send({{"do", "put"},
            {"array", array.number},
            {"first", asked * at_once},
            {"count", count_of(asked)},
            {"slot", asked % slots}},
           subject);
      ++asked;
    };
    const auto await = [&] {
      const HelperMessage reply = receive(subject);
      ++came;
      content_of(reply, subject);
    };
    try {
      while (asked < std::min<std::uint64_t>(parts, slots)) ask();
      for (std::uint64_t part = 0; part < parts; ++part) {
        await();
        use(window_.bytes().subspan(part % slots * slot_bytes, count_of(part) * tuple));
        received_ += count_of(part) * tuple;
        if (task_.progress && expected_ > 0)
          task_.progress({ReadProgress::Stage::copying,
                          std::min(static_cast<double>(received_) / static_cast<double>(expected_), 1.0)});
        if (asked < parts) ask();
      }
    } catch (...) {
      for (; came < asked && !death_; ++came)
        if (!receive_message(socket_.get())) break;
      throw;
    }
  }
  if (then == Then::dropped) drop(std::span(&array.number, 1));
}

SharedBytes HelperProcess::take(const ForeignArray& array, const std::string& subject, bool keep) {
  const HelperMessage reply = exchange({{"do", "take"}, {"array", array.number}, {"keep", keep}}, subject);
  try {
    return {reply.file, array.bytes()};
  } catch (const std::invalid_argument&) {
    throw scene::bad_input(fmt::format("{}: its array '{}' cannot be read; write the file again, or in another format",
                                       subject, array.name));
  }
}

void HelperProcess::drop(std::span<const std::uint64_t> arrays) noexcept {
  try {
    const std::lock_guard lock(mutex_);
    if (!death_)
      static_cast<void>(send_message(
          socket_.get(),
          Json::to_cbor({{"do", "drop"}, {"arrays", std::vector<std::uint64_t>(arrays.begin(), arrays.end())}})));
  } catch (const std::exception&) {  // the helper then keeps the arrays until it ends
  }
}

}  // namespace tessera::io
