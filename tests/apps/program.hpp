// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tessera::apps {

std::string contents(const std::string& file);

/// What a run of the program left behind.
struct Outcome {
  int status = -1;  ///< exit status; 128 + signal if it was killed
  std::string out, err;
  [[nodiscard]] std::size_t error_lines()
      const;  ///< of `err`; not those that go on with the one before, nor MPI's remarks on the machine
  /// Of `err`, those of the program's own; a launcher may put words before them and lines of its own between them.
  [[nodiscard]] std::vector<std::string> own_lines() const;
};

/// Runs the built `tessera` with these arguments, no shell in between, standard input empty.
Outcome tessera(const std::vector<std::string>& arguments);
/// The same with standard output going to a file.
Outcome tessera_to(const std::filesystem::path& standard_output, const std::vector<std::string>& arguments);

/// The same on several ranks. For tests that have asked has_mpirun().
bool has_mpirun();
Outcome mpirun(int ranks, const std::vector<std::string>& arguments);
/// The words of that command line.
std::vector<std::string> mpirun_command(int ranks, const std::vector<std::string>& arguments);
/// Words, and more of them.
std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more);
/// Processes of the ranks that now run with `word` in their arguments, by rank.
std::map<int, pid_t> ranks_with(const std::string& word);

/// What /proc says of a process.
struct ProcessState {
  char letter = 'X';  ///< of proc(5): Z a zombie, X gone
  pid_t parent = 0;
  long ticks = 0;  ///< of the processor, in user mode
  [[nodiscard]] bool is_alive() const { return letter != 'X' && letter != 'Z'; }
};
ProcessState state_of(pid_t process);

/// A folder of one test's own, removed at its end.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Names of all that lies in it, sorted.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Writes a small file and gives its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const;
  /// A small generated mesh in it: 4^3 voxels of six tets.
  [[nodiscard]] std::string cube() const;
  /// A small rectilinear grid in it, a.vtr: 12^3 points, spacings that grow along each axis.
  [[nodiscard]] std::string rectilinear() const;

 private:
  std::filesystem::path path_;
};

/// A command that runs while a test does something to it. Killed at the end unless it has been waited for.
class Running {
 public:
  explicit Running(const std::vector<std::string>& command);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  [[nodiscard]] pid_t process() const { return process_; }
  [[nodiscard]] bool runs() const;
  /// What it has written to standard error so far.
  [[nodiscard]] std::string errors() const { return contents(folder_ / "err"); }
  /// Its end. One that does not come is a failure, and the command is killed.
  Outcome wait();
  /// The same for a launcher that may hang, which is not a failure.
  Outcome wait_or_kill();

 private:
  const Folder folder_;
  pid_t process_;
};

}  // namespace tessera::apps
