#pragma once

#include <sys/types.h>

#include <string>

namespace tessera::exchange {

/// A child process that lives while MPI starts. MPI ends a process that it cannot start, by _exit() with words of its
/// own; then the child says what the user can do, in the run's line. Without a second process nobody is left to.
class StartWitness {
 public:
  /// `program` begins the line. Before MPI starts and before there are threads. Does nothing if the system gives no
  /// process.
  explicit StartWitness(const std::string& program);
  /// This process goes on: the child ends without a word.
  ~StartWitness();
  /// The child says `line` in place of its own words once this process has ended, and in the run's line too. It holds
  /// the line when the launcher ends the others, whose children then keep silent.
  void leave_words(const std::string& line) const;
  StartWitness(const StartWitness&) = delete;
  StartWitness& operator=(const StartWitness&) = delete;

 private:
  pid_t child_ = -1;
  int to_child_ = -1;
};

}  // namespace tessera::exchange
