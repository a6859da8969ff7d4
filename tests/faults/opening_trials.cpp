// SPDX-License-Identifier: BSD-3-Clause
/// Damages files and opens them with the library, many in one process: third-party readers run in a helper program,
/// which may die, but this process may not.
///
///     `opening_trials RUNS SEED FOLDER [LARGEST]`
///
/// `FOLDER` contains files of at most LARGEST bytes (default 262144); those that cannot be opened are left out. Each
/// run damages one and opens it. A fault is: an exception other than Error(bad_input), a message of more than one line
/// or without the file's name, over 20 s, or more than twice the memory of the intact file plus 256 MiB, in this
/// process or the helper. The 20 s are processor time, whatever else the machine does; after 300 s of wall time it
/// counts as a hang. A process's peak memory never decreases, so a run that stays below an earlier peak is not checked.
/// The file of a fault is kept in the working directory as opening_trial_RUN_NAME. Prints the faults and the counts;
/// exits with status 1 if there are any, with 2 if nothing can be tried.
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tessera/dataset.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"

namespace {

using Random = std::mt19937_64;
namespace fs = std::filesystem;

constexpr double most_seconds = 20;   ///< of processor time
constexpr double hang_seconds = 300;  ///< of wall time, reached only by a hang
constexpr long spare_mebibytes = 256;

double processor_seconds() {
  double seconds = 0;
  for (const int process : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(process, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime})
      seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return seconds;
}

std::size_t below(Random& random, std::size_t end) { return end == 0 ? 0 : random() % end; }

void flip_bits(std::string& bytes, Random& random, std::size_t reach) {
  static constexpr std::size_t counts[] = {1, 1, 2, 4, 16};
  for (std::size_t n = counts[below(random, std::size(counts))]; n > 0; --n) {
    char& byte = bytes[below(random, std::min(reach, bytes.size()))];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << below(random, 8)));
  }
}

/// Replaces one of the first 400 numbers written as text by another.
void change_number(std::string& bytes, Random& random) {
  static const std::string numbers[] = {"0",          "-1",         "1",   "255",   "65536", "999999",
                                        "2147483647", "2147483648", "nan", "1e308", "",      "99999999999999999999"};
  std::vector<std::pair<std::size_t, std::size_t>> found;
  constexpr const char* digits = "0123456789";
  for (std::size_t at = bytes.find_first_of(digits);
       at < std::min<std::size_t>(bytes.size(), 65536) && found.size() < 400;) {
    const std::size_t end = std::min(bytes.find_first_not_of(digits, at), bytes.size());
    found.emplace_back(at, end - at);
    at = bytes.find_first_of(digits, end);
  }
  if (found.empty()) return flip_bits(bytes, random, 2048);
  const auto [at, count] = found[below(random, found.size())];
  bytes.replace(at, count, numbers[below(random, std::size(numbers))]);
}

/// Replaces eight bytes that may be an offset or a count, at a multiple of four of a binary part.
void change_word(std::string& bytes, Random& random) {
  const std::size_t mark = bytes.find("<AppendedData");
  std::size_t at = mark == std::string::npos ? 4 * below(random, bytes.size() / 4 + 1)
                                             : bytes.find('_', mark) + 1 + 8 * below(random, 16);
  const std::uint64_t words[] = {0, ~std::uint64_t{0}, random(), random() % (std::uint64_t{1} << 34), random() % 4096};
  const std::uint64_t word = words[below(random, std::size(words))];
  for (std::size_t i = 0; i < 8 && at + i < bytes.size(); ++i) bytes[at + i] = static_cast<char>(word >> (8 * i));
}

void cut(std::string& bytes, Random& random) {
  const std::size_t at = below(random, bytes.size());
  bytes.erase(at, random() % 2 != 0 ? std::string::npos : 1 + below(random, 4096));
}

void exchange_stretches(std::string& bytes, Random& random) {
  const std::size_t size = 1 + below(random, std::min<std::size_t>(512, bytes.size() / 2));
  const std::size_t a = below(random, bytes.size() - size + 1), b = below(random, bytes.size() - size + 1);
  const std::string first = bytes.substr(a, size), second = bytes.substr(b, size);
  bytes.replace(a, size, second);
  bytes.replace(b, size, first);
}

void damage(std::string& bytes, Random& random) {
  switch (below(random, 10)) {
    case 0:
    case 1:
      return flip_bits(bytes, random, bytes.size());
    case 2:
    case 3:
      return flip_bits(bytes, random, 2048);
    case 4:
    case 5:
    case 6:
      return change_number(bytes, random);
    case 7:
      return change_word(bytes, random);
    case 8:
      return cut(bytes, random);
    default:
      return exchange_stretches(bytes, random);
  }
}

/// The fault in opening a file; empty: none. `taken` is set to whether it was opened.
std::string fault_of(const fs::path& file, bool& taken) {
  taken = false;
  const auto begin = std::chrono::steady_clock::now();
  const double used = processor_seconds();
  std::string fault;
  try {
    tessera::ReadOptions options;
    options.threads = 1;
    (void)tessera::Dataset::open(file, options);
    taken = true;
  } catch (const tessera::Error& e) {
    const std::string line = e.what();
    if (e.code() != tessera::ErrorCode::bad_input) fault += "not bad input: " + line;
    if (line.find('\n') != std::string::npos) fault += "more than one line: " + line;
    if (line.find(file.stem().string()) == std::string::npos) fault += "does not name the file: " + line;
  } catch (const std::exception& e) {
    fault = fmt::format("another exception: {}", e.what());
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double processor = processor_seconds() - used;  // includes a helper that has ended
  if (processor > most_seconds || seconds > hang_seconds)
    fault += fmt::format("{:.0f} s, {:.0f} s of the processor; ", seconds, processor);
  return fault;
}

/// Peak memory of this process, and of a helper, MiB.
struct Memory {
  long own = 0, helper = 0;
};

Memory memory_so_far() {
  rusage own{}, helpers{};
  getrusage(RUSAGE_SELF, &own);
  getrusage(RUSAGE_CHILDREN, &helpers);
  return {own.ru_maxrss / 1024, helpers.ru_maxrss / 1024};
}

/// Memory for an intact file, measured in a separate process; no value if it cannot be opened.
std::optional<Memory> memory_of_intact(const fs::path& file) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    bool opened = false;
    (void)fault_of(file, opened);
    const Memory memory = memory_so_far();
    const bool is_written = opened && ::write(ends[1], &memory, sizeof(memory)) == sizeof(memory);
    ::_exit(is_written ? 0 : 1);
  }
  ::close(ends[1]);
  Memory memory;
  const bool is_written = ::read(ends[0], &memory, sizeof(memory)) == sizeof(memory);
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return is_written ? std::optional(memory) : std::nullopt;
}

/// The fault in the memory of a run, given the peaks before and after it.
std::string memory_fault(const Memory& before, const Memory& after, const Memory& intact) {
  std::string fault;
  const auto judge = [&](const char* process, long had, long has, long whole) {
    if (has > had && has > 2 * whole + spare_mebibytes)
      fault += fmt::format("{} {} MiB, intact {}; ", process, has, whole);
  };
  judge("this process", before.own, after.own, intact.own);
  judge("the helper", before.helper, after.helper, intact.helper);
  return fault;
}

std::string read_all(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_all(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A directory in memory if available: hundreds of files per second are written.
fs::path scratch_folder() {
  std::string name =
      (fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) / "tessera-trials-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  return name;
}

int trials(std::size_t runs, std::uint64_t seed, const fs::path& folder, std::uintmax_t largest) {
  struct File {
    std::string name, bytes;
    Memory intact;
  };
  std::vector<File> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.file_size() > 1 && entry.file_size() <= largest)
      files.push_back({entry.path().filename().string(), read_all(entry.path()), {}});
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.name < b.name; });
  const fs::path scratch = scratch_folder();
  std::erase_if(files, [&](File& file) {
    write_all(scratch / file.name, file.bytes);
    const std::optional<Memory> intact = memory_of_intact(scratch / file.name);
    file.intact = intact.value_or(Memory{});
    return !intact;
  });
  if (files.empty())
    return fmt::print(stderr, "opening_trials: {} holds no file that can be opened\n", folder.string()), 2;
  std::map<std::string, std::size_t> taken, refused;
  std::size_t faults = 0;
  for (std::size_t run = 0; run < runs; ++run) {
    Random random(seed * 1'000'003 + run);
    const auto& [name, whole, intact] = files[below(random, files.size())];
    std::string bytes = whole;
    damage(bytes, random);
    const fs::path file = scratch / name;
    write_all(file, bytes);
    bool opened = false;
    ::malloc_trim(0);  // memory kept from earlier runs does not count for this one
    const Memory before = memory_so_far();
    const std::string fault = fault_of(file, opened) + memory_fault(before, memory_so_far(), intact);
    ++(opened ? taken : refused)[file.extension().string()];
    fs::remove(file);
    if (fault.empty()) continue;
    ++faults;
    write_all(fmt::format("opening_trial_{}_{}", run, name), bytes);
    fmt::print("run {} of seed {}, {}: {}\n", run, seed, name, fault);
  }
  fs::remove_all(scratch);
  const Memory most = memory_so_far();
  for (const auto& [kind, count] : refused) taken.try_emplace(kind, 0);
  for (const auto& [kind, count] : taken) fmt::print("{:10} {} taken, {} refused\n", kind, count, refused[kind]);
  fmt::print("{} damaged files of {}, {} faults; memory {} MiB, helpers at most {} MiB\n", runs, files.size(), faults,
             most.own, most.helper);
  return faults > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) return fmt::print(stderr, "usage: opening_trials RUNS SEED FOLDER [LARGEST]\n"), 2;
  return trials(std::stoul(argv[1]), std::stoull(argv[2]), argv[3], argc > 4 ? std::stoull(argv[4]) : 1 << 18);
} catch (const std::exception& e) {
  fmt::print(stderr, "opening_trials: {}\n", e.what());
  return 2;
}
