#include "exchange/start_witness.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>

#include "exchange/first_contact.hpp"
#include "exchange/one_line.hpp"

namespace tessera::exchange {
namespace {

std::string words(const std::string& program) {
  return fmt::format("{}: MPI: a rank ended while MPI started, its words are above; {}\n", program, memory_remedy());
}

/// A zero: the process goes on. Else these are its last words, up to its end.
std::string told(int descriptor) {
  std::string all;
  for (;;) {
    char next = 0;
    const ssize_t got = read(descriptor, &next, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return all;
    all.push_back(next);
    if (next == '\0') return all;
  }
}

void write_all(int descriptor, const std::string& text) {
  const ssize_t ignored = write(descriptor, text.data(), text.size());
  static_cast<void>(ignored);
}

}  // namespace

StartWitness::StartWitness(const std::string& program) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return;
  child_ = fork();
  if (child_ == 0) {
    close(ends[1]);
    // A launcher that ends a rank ends the rank's process group, and would take the words with it, or the hold of the
    // line while others still end.
    setsid();
    std::signal(SIGTERM, SIG_IGN);  // which may be meant for all processes of this name
    const std::string last = told(ends[0]);
    if (!last.ends_with('\0') && may_speak()) {
      write_all(STDERR_FILENO, last.empty() ? words(program) : last);
      hold_one_line();
    }
    _exit(0);
  }
  close(ends[0]);
  to_child_ = ends[1];
}

StartWitness::~StartWitness() {
  if (to_child_ < 0) return;
  if (child_ > 0) write_all(to_child_, std::string(1, '\0'));
  close(to_child_);
  if (child_ > 0) waitpid(child_, nullptr, 0);
}

void StartWitness::leave_words(const std::string& line) const {
  if (child_ > 0) write_all(to_child_, line);
}

}  // namespace tessera::exchange
