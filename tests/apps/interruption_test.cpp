// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C and similar signals end every command at once and leave nothing behind; and the output on a terminal until
// then.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/program.hpp"
#include "cells/surface.hpp"
#include "io/files/reader_programs.hpp"
#include "support/await.hpp"

namespace tessera::apps {
namespace {

namespace fs = std::filesystem;
/// A variable in the environment of a test's command, which identifies all processes started by it.
class Mark {
 public:
  Mark() : word_("TESSERA_TEST_MARK=" + std::to_string(::getpid()) + "-" + std::to_string(++count())) {
    ::setenv("TESSERA_TEST_MARK", word_.substr(word_.find('=') + 1).c_str(), 1);
  }
  ~Mark() {
    ::unsetenv("TESSERA_TEST_MARK");
    for (const pid_t process : processes()) ::kill(process, SIGKILL);
  }
  Mark(const Mark&) = delete;
  Mark& operator=(const Mark&) = delete;

  /// Processes that have this variable, except zombies.
  [[nodiscard]] std::vector<pid_t> processes() const {
    std::vector<pid_t> found;
    std::error_code gone;
    for (const auto& entry : fs::directory_iterator("/proc", gone)) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") == std::string::npos &&
          ('\0' + contents(entry.path() / "environ")).find('\0' + word_ + '\0') != std::string::npos)
        found.push_back(std::stoi(name));
    }
    return found;
  }
  /// Waits until no such process remains; false if one remains. The kernel needs time to free gigabytes.
  [[nodiscard]] bool is_gone() const {
    return test::await([this] { return processes().empty(); });
  }
  /// Processor time of the current processes, in clock ticks.
  [[nodiscard]] long ticks() const {
    long sum = 0;
    for (const pid_t process : processes()) sum += state_of(process).ticks;
    return sum;
  }

 private:
  static int& count() {
    static int number = 0;
    return number;
  }
  std::string word_;
};

/// A command at its own pseudo-terminal.
class AtTerminal {
 public:
  explicit AtTerminal(const std::vector<std::string>& command) {
    std::vector<char*> words;
    for (const auto& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    process_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (process_ == 0) {
      ::execvp(words.front(), words.data());
      ::_exit(127);
    }
  }
  ~AtTerminal() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
    ::close(terminal_);
  }
  AtTerminal(const AtTerminal&) = delete;
  AtTerminal& operator=(const AtTerminal&) = delete;

  /// Waits until the command has printed `text`. Returns false if the command ends before.
  bool shows(const std::string& text) {
    while (shown_.find(text) == std::string::npos)
      if (!read_more()) return false;
    return true;
  }
  void press_control_c() const { ASSERT_EQ(::write(terminal_, "\x03", 1), 1); }
  /// Waits for the command's end. Returns its exit status, or 128 + signal if a signal ended it.
  int wait() {
    while (read_more()) {
    }
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  [[nodiscard]] const std::string& shown() const { return shown_; }

 private:
  bool read_more() {
    char bytes[4096];
    ssize_t got = 0;
    while ((got = ::read(terminal_, bytes, sizeof bytes)) < 0 && errno == EINTR) {
    }
    if (got <= 0) return false;  // EIO once the other end is closed
    shown_.append(bytes, static_cast<std::size_t>(got));
    return true;
  }
  pid_t process_ = -1;
  int terminal_ = -1;
  std::string shown_;
};

std::vector<std::string> program(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TESSERA_PROGRAM);
  return arguments;
}

/// A plate with a thickness of a millionth of its width: TetGen fills it for minutes with more tets than fit into
/// memory.
std::string plate(const Folder& folder) {
  return folder.file("plate.poly",
                     "8 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1e-6\n6 1 0 1e-6\n7 1 1 1e-6\n8 0 1 1e-6\n"
                     "6 0\n1\n4 1 2 3 4\n1\n4 5 6 7 8\n1\n4 1 2 6 5\n1\n4 2 3 7 6\n1\n4 3 4 8 7\n1\n4 4 1 5 8\n0\n");
}

/// Starts the command, sends the signal once `when` is true for the marked processes, and checks what remains. Without
/// the signal, the work would take many times as long.
template <class When>
void expect_clean_end(const Folder& folder, const std::vector<std::string>& arguments, int signal, const When& when) {
  SCOPED_TRACE(testing::Message() << arguments[0] << ", signal " << signal);
  const Mark mark;
  const std::vector<std::string> before = folder.names();
  Running running(program(arguments));
  ASSERT_TRUE(test::await([&] { return when(mark) || !running.runs(); }, std::chrono::milliseconds(10)));
  ASSERT_TRUE(running.runs()) << running.wait().err;
  ASSERT_EQ(::kill(running.process(), signal), 0);
  const Outcome outcome = running.wait();
  EXPECT_EQ(outcome.status, 128 + signal);
  EXPECT_LE(outcome.error_lines(), 1u) << outcome.err;
  EXPECT_TRUE(mark.is_gone());
  EXPECT_EQ(folder.names(), before);
}

/// Why no terminal can be used; empty if one can.
std::string no_terminal() {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0) return "this machine has no pseudo-terminals (/dev/ptmx)";
  const bool opens = ::grantpt(terminal) == 0 && ::unlockpt(terminal) == 0 && ::ptsname(terminal) != nullptr &&
                     ::access(::ptsname(terminal), R_OK | W_OK) == 0;
  ::close(terminal);
  return opens ? "" : "this machine's pseudo-terminals do not open (/dev/pts)";
}

TEST(Interruption, EndsEveryCommandAtOnceAndLeavesNothing) {
  const Folder folder;
  const std::string mesh = folder / "mesh.tets", large = folder / "large.tets";
  ASSERT_EQ(tessera({"generate", "cube", mesh, "n=4", "--quiet"}).status, 0);
  ASSERT_EQ(tessera({"generate", "cube", large, "n=30", "--quiet"}).status, 0);
  // The signal is sent at once, at the beginning of the command's work, or during the work. Signals differ only in
  // their number, so not every combination is tested.
  for (const auto& [signal, moments] :
       {std::pair<int, std::vector<long>>{SIGINT, {0, 2, 30}}, {SIGTERM, {2}}, {SIGHUP, {30}}})
    for (const long ticks : moments) {
      const auto when = [ticks](const Mark& mark) { return mark.ticks() >= ticks; };
      expect_clean_end(folder, {"render", large, "-o", folder / "a.png", "--size", "16384x16384"}, signal, when);
      expect_clean_end(folder, {"generate", "cube", folder / "b.vtu", "n=250"}, signal, when);
      expect_clean_end(folder, {"convert", large, folder / "c.vtu", "--subdivide", "4"}, signal, when);
      expect_clean_end(folder, {"chart", large, "--budget-seconds", "1000", "--json", folder / "d.json"}, signal, when);
      if (io::has_reader(io::Reader::tetgen))
        expect_clean_end(folder, {"info", plate(folder), "--max-volume", "1e-10"}, signal, when);
    }
}

TEST(Interruption, OfAFilmEndsTheProgramThatMakesIt) {
  const Folder folder;
  const std::string mesh = folder.cube(), path = std::getenv("PATH");
  fs::create_directory(folder / "bin");
  // An encoder that would run long after the last image.
  fs::permissions(folder.file("bin/ffmpeg", "#!/bin/sh\ncat > /dev/null\nexec sleep 100000\n"), fs::perms::owner_all);
  ::setenv("PATH", (folder / "bin:/usr/bin:/bin").c_str(), 1);
  for (const int signal : {SIGINT, SIGTERM})
    expect_clean_end(folder,
                     {"render", mesh, "-o", folder / "a.mp4", "--orbit", "100000", "--size", "64x64", "--quiet"},
                     signal, [](const Mark& mark) { return mark.processes().size() > 1; });
  ::setenv("PATH", path.c_str(), 1);
}

TEST(Interruption, LeavesTheFinishedPicturesOfASeriesWhole) {
  const Folder folder;
  const std::string mesh = folder.cube();
  Running running(
      program({"render", mesh, "-o", folder / "%d.pfm", "--orbit", "100000", "--size", "64x64", "--quiet"}));
  ASSERT_TRUE(test::await([&] { return folder.names().size() >= 20; }));
  ASSERT_EQ(::kill(running.process(), SIGINT), 0);
  EXPECT_EQ(running.wait().status, 130);
  const auto whole = fs::file_size(folder / "0.pfm");
  for (const std::string& name : folder.names()) {
    if (name == "cube.vtu") continue;
    EXPECT_TRUE(name.ends_with(".pfm")) << name;
    EXPECT_EQ(fs::file_size(folder / name), whole) << name;
  }
}

TEST(Interruption, StaysIgnoredWhereTheCallerHasItIgnored) {
  const Folder folder;
  // Children inherit the ignored signal, as under nohup.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGHUP, SIG_IGN);
  Running running(program({"generate", "cube", folder / "a.tets", "n=40", "--quiet"}));
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGHUP, SIG_DFL);
  EXPECT_TRUE(test::await([&] {
    for (const int signal : {SIGINT, SIGHUP}) ::kill(running.process(), signal);
    return !running.runs();
  }));
  EXPECT_EQ(running.wait().status, 0);
  EXPECT_TRUE(fs::exists(folder / "a.tets"));
}

TEST(Interruption, AtATerminalControlCTakesTheLineOfProgressAway) {
  if (const std::string reason = no_terminal(); !reason.empty()) GTEST_SKIP() << reason;
  const Folder folder;
  const std::string mesh = folder.cube();
  const Mark mark;
  const std::vector<std::string> before = folder.names();
  AtTerminal run(program({"render", mesh, "-o", folder / "a.png", "--size", "16384x16384", "--threads", "1"}));
  ASSERT_TRUE(run.shows("rendering 16384x16384")) << run.shown();
  run.press_control_c();
  EXPECT_EQ(run.wait(), 130);
  EXPECT_TRUE(run.shown().ends_with("\r\x1b[Ktessera: ended by Ctrl-C; no incomplete output files are left\r\n"))
      << run.shown();
  EXPECT_TRUE(mark.is_gone());
  EXPECT_EQ(folder.names(), before);
}

TEST(Interruption, AtATerminalControlCEndsFillingByTetGen) {
  if (!io::has_reader(io::Reader::tetgen)) GTEST_SKIP() << "tessera-read-tetgen is not installed";
  if (const std::string reason = no_terminal(); !reason.empty()) GTEST_SKIP() << reason;
  const Folder folder;
  const Mark mark;
  AtTerminal run(program({"info", plate(folder), "--max-volume", "1e-10"}));
  ASSERT_TRUE(run.shows("reading plate.poly: filling it with tets")) << run.shown();
  run.press_control_c();
  // The helper is at the same terminal: its death by the signal must not be reported as a crash.
  EXPECT_EQ(run.wait(), 130);
  EXPECT_EQ(run.shown().find("crashed"), std::string::npos) << run.shown();
  EXPECT_TRUE(mark.is_gone());
}

}  // namespace
}  // namespace tessera::apps
