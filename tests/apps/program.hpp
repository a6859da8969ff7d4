// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tessera::apps {

std::string contents(const std::string& file);

/// The results of a run of the program.
struct Outcome {
  int status = -1;  ///< exit status; 128 + signal if it was killed
  std::string out, err;
  [[nodiscard]] std::size_t error_lines()
      const;  ///< number of lines in `err`, without continuation lines and MPI's remarks on the machine
  /// The program's own lines in `err`; a launcher may prefix them and print others in between.
  [[nodiscard]] std::vector<std::string> own_lines() const;
};

/// Runs the built `tessera` with these arguments, without a shell and with empty standard input.
Outcome tessera(const std::vector<std::string>& arguments);
/// Like tessera(), with standard output to a file.
Outcome tessera_to(const std::filesystem::path& standard_output, const std::vector<std::string>& arguments);

/// Like tessera(), on several ranks. Tests must check has_mpirun() before they call mpirun().
bool has_mpirun();
Outcome mpirun(int ranks, const std::vector<std::string>& arguments);
/// The words of the command line of mpirun().
std::vector<std::string> mpirun_command(int ranks, const std::vector<std::string>& arguments);
/// Concatenates two lists of words.
std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more);
/// Process ids of the running ranks with `word` in their arguments, by rank.
std::map<int, pid_t> ranks_with(const std::string& word);

/// State of a process according to /proc.
struct ProcessState {
  char letter = 'X';  ///< see proc(5): Z a zombie, X gone
  pid_t parent = 0;
  long ticks = 0;  ///< processor time in user mode, in clock ticks
  [[nodiscard]] bool is_alive() const { return letter != 'X' && letter != 'Z'; }
};
ProcessState state_of(pid_t process);

/// A temporary directory of one test.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Names of everything in the directory, sorted.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Writes a small file and returns its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const;
  /// Generates a small mesh in the directory, 4^3 voxels of six tets, and returns its path.
  [[nodiscard]] std::string cube() const;
  /// Generates a small rectilinear grid in the directory, a.vtr: 12^3 points, spacings that grow along each axis.
  [[nodiscard]] std::string rectilinear() const;

 private:
  std::filesystem::path path_;
};

/// A command that runs while a test acts on it. Killed at the end unless it has been waited for.
class Running {
 public:
  explicit Running(const std::vector<std::string>& command);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  [[nodiscard]] pid_t process() const { return process_; }
  [[nodiscard]] bool runs() const;
  /// The command's standard error so far.
  [[nodiscard]] std::string errors() const { return contents(folder_ / "err"); }
  /// Waits for the command's end. If the command does not end, the test fails and the command is killed.
  Outcome wait();
  /// Does the same for a launcher that may hang. A launcher that hangs is not a failure.
  Outcome wait_or_kill();

 private:
  const Folder folder_;
  pid_t process_;
};

}  // namespace tessera::apps
