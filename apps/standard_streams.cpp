// SPDX-License-Identifier: BSD-3-Clause
#include "apps/standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "tessera/error.hpp"

namespace tessera::apps {
namespace {

/// Name of the file with the contents of standard input. It is set once, before any other thread runs.
std::string& spooled_name() {
  static std::string name;
  return name;
}

}  // namespace

std::filesystem::path spool_standard_input() {
  if (::isatty(STDIN_FILENO) == 1)
    throw bad_input("standard input: it is a terminal; send a file to it, tessera render - -o image.png < FILE");
  const auto fail = [](const char* what) {
    throw Error(ErrorCode::system_failure, "standard input",
                fmt::format("{} {}: {}", what, std::filesystem::temp_directory_path().string(), std::strerror(errno)),
                "free some space there, or set TMPDIR to another directory");
  };
  // The file remains open until the process ends, because its name refers to an open file of this process.
  int file = ::open(std::filesystem::temp_directory_path().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) {
    std::string name = (std::filesystem::temp_directory_path() / "tessera-XXXXXX").string();
    file = ::mkostemp(name.data(), O_CLOEXEC);
    if (file < 0) fail("no file for its contents can be created in");
    ::unlink(name.c_str());
  }
  std::array<char, 1 << 16> bytes{};
  std::uint64_t all = 0;
  for (ssize_t got = 0; (got = ::read(STDIN_FILENO, bytes.data(), bytes.size())) != 0;) {
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("it cannot be read to");
    for (ssize_t done = 0, written = 0; done < got; done += written)
      if ((written = ::write(file, bytes.data() + done, static_cast<std::size_t>(got - done))) < 0)
        fail("it cannot be kept in");
    all += static_cast<std::uint64_t>(got);
  }
  if (all == 0) throw bad_input("standard input: it is empty; send a file to it");
  spooled_name() = fmt::format("/proc/{}/fd/{}", ::getpid(), file);
  return spooled_name();
}

std::string with_stream_names(std::string text) {
  const std::string& name = spooled_name();
  if (name.empty()) return text;
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos;)
    text.replace(at, name.size(), "standard input");
  return text;
}

void require_no_terminal(const char* option) {
  if (::isatty(STDOUT_FILENO) == 1)
    throw bad_input(
        fmt::format("{} -: standard output is a terminal; send it to a file, > FILE, or to a program", option));
}

void write_standard_output(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
    throw Error(ErrorCode::system_failure,
                "standard output: it cannot be written; free disk space, or keep the reading program open");
}

}  // namespace tessera::apps
