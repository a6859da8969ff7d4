#include "exchange/start_witness.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "exchange/first_contact.hpp"
#include "exchange/one_line.hpp"

namespace tessera::exchange {
namespace {

std::string words(const std::string& program) {
  return fmt::format("{}: MPI: a rank ended while MPI started, its words are above; {}\n", program, memory_remedy());
}

/// Returns when the other end has written or is gone: whether it has written.
bool is_told(int descriptor) {
  char word = 0;
  ssize_t got = 0;
  do got = read(descriptor, &word, 1);
  while (got < 0 && errno == EINTR);
  return got == 1;
}

}  // namespace

StartWitness::StartWitness(const std::string& program) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return;
  child_ = fork();
  if (child_ == 0) {
    close(ends[1]);
    if (!is_told(ends[0]) && may_speak()) {
      const std::string line = words(program);
      const ssize_t ignored = write(STDERR_FILENO, line.data(), line.size());
      static_cast<void>(ignored);
      hold_one_line();
    }
    _exit(0);
  }
  close(ends[0]);
  to_child_ = ends[1];
}

StartWitness::~StartWitness() {
  if (to_child_ < 0) return;
  if (child_ > 0) {
    const ssize_t ignored = write(to_child_, "", 1);
    static_cast<void>(ignored);
  }
  close(to_child_);
  if (child_ > 0) waitpid(child_, nullptr, 0);
}

}  // namespace tessera::exchange
