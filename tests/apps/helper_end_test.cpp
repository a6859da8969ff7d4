// A reading program ends with the program that started it, however that ends.
#include <gtest/gtest.h>
#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>

#include "apps/program.hpp"
#include "io/reader_programs.hpp"
#include "io/surface.hpp"

namespace tessera::apps {
namespace {

struct ProcessState {
  char letter = 'X';  ///< of proc(5): Z a zombie, X gone
  pid_t parent = 0;
  long ticks = 0;  ///< of the processor, in user mode
};

ProcessState state_of(pid_t process) {
  ProcessState state;
  std::string text = contents("/proc/" + std::to_string(process) + "/stat");
  std::istringstream words(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  std::string skipped;
  words >> state.letter >> state.parent;
  for (int k = 0; k < 9; ++k) words >> skipped;
  words >> state.ticks;
  return state;
}

bool is_alive(pid_t process) {
  const char letter = state_of(process).letter;
  return letter != 'X' && letter != 'Z';
}

/// A child that has computed for a tenth of a second; 0: none within `seconds`.
pid_t busy_child_of(const Running& running, int seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  std::error_code gone;
  for (; running.runs() && std::chrono::steady_clock::now() < end;
       std::this_thread::sleep_for(std::chrono::milliseconds(20)))
    for (const auto& entry : std::filesystem::directory_iterator("/proc", gone)) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      const pid_t process = std::stoi(name);
      if (const ProcessState state = state_of(process); state.parent == running.process() && state.ticks >= 10)
        return process;
    }
  return 0;
}

TEST(HelperEnd, OfACallerThatIsKilledAReadingProgramEndsAtOnce) {
  if (!io::has_reader(io::Reader::tetgen)) GTEST_SKIP() << "tessera-read-tetgen is not installed";
  const Folder folder;
  // A plate of a millionth of its width: TetGen fills it with more tets than there is memory for, over minutes.
  const std::string plate = folder.file("plate.poly",
                                        "8 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
                                        "5 0 0 1e-6\n6 1 0 1e-6\n7 1 1 1e-6\n8 0 1 1e-6\n"
                                        "6 0\n1\n4 1 2 3 4\n1\n4 5 6 7 8\n1\n4 1 2 6 5\n1\n4 2 3 7 6\n1\n4 3 4 8 7\n"
                                        "1\n4 4 1 5 8\n0\n");
  for (const int signal : {SIGKILL, SIGTERM}) {
    Running running({TESSERA_PROGRAM, "info", plate, "--max-volume", "1e-10"});
    const pid_t helper = busy_child_of(running, 60);
    ASSERT_GT(helper, 0) << running.wait().err;
    ASSERT_EQ(kill(running.process(), signal), 0);
    running.wait();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    while (is_alive(helper) && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(is_alive(helper)) << "after signal " << signal;
    if (is_alive(helper)) kill(helper, SIGKILL);
  }
}

}  // namespace
}  // namespace tessera::apps
