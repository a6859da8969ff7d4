// SPDX-License-Identifier: BSD-3-Clause
// A reader program ends with the program that started it, however that ends.
#include <gtest/gtest.h>
#include <sys/types.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "apps/program.hpp"
#include "cells/surface.hpp"
#include "io/files/reader_programs.hpp"
#include "support/await.hpp"

namespace tessera::apps {
namespace {

/// Returns a child that has computed for a tenth of a second; 0 if the command ended without such a child.
pid_t busy_child_of(const Running& running) {
  pid_t found = 0;
  std::error_code gone;
  const auto look = [&] {
    for (const auto& entry : std::filesystem::directory_iterator("/proc", gone)) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      const pid_t process = std::stoi(name);
      if (const ProcessState state = state_of(process); state.parent == running.process() && state.ticks >= 10)
        found = process;
    }
    return found > 0 || !running.runs();
  };
  return test::await(look) ? found : 0;
}

TEST(HelperEnd, AReaderProgramEndsWhenItsCallerIsKilled) {
  if (!io::has_reader(io::Reader::tetgen)) GTEST_SKIP() << "tessera-read-tetgen is not installed";
  const Folder folder;
  // A plate with a thickness of a millionth of its width: TetGen fills it for minutes with more tets than fit into
  // memory.
  const std::string plate = folder.file("plate.poly",
                                        "8 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
                                        "5 0 0 1e-6\n6 1 0 1e-6\n7 1 1 1e-6\n8 0 1 1e-6\n"
                                        "6 0\n1\n4 1 2 3 4\n1\n4 5 6 7 8\n1\n4 1 2 6 5\n1\n4 2 3 7 6\n1\n4 3 4 8 7\n"
                                        "1\n4 4 1 5 8\n0\n");
  for (const int signal : {SIGKILL, SIGTERM}) {
    Running running({TESSERA_PROGRAM, "info", plate, "--max-volume", "1e-10"});
    const pid_t helper = busy_child_of(running);
    ASSERT_GT(helper, 0) << running.wait().err;
    ASSERT_EQ(kill(running.process(), signal), 0);
    running.wait();
    // The reader program's work would continue for minutes, until memory runs out.
    const bool ends = test::await([&] { return !state_of(helper).is_alive(); });
    EXPECT_TRUE(ends) << "after signal " << signal;
    if (!ends) kill(helper, SIGKILL);
  }
}

}  // namespace
}  // namespace tessera::apps
