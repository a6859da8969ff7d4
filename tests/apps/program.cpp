// SPDX-License-Identifier: BSD-3-Clause
#include "apps/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "support/await.hpp"

namespace tessera::apps {
namespace {

/// Makes `path` the descriptor `target`, in the child between fork and exec.
void redirect(const char* path, int flags, int target) {
  const int descriptor = open(path, flags, 0600);
  if (descriptor < 0 || dup2(descriptor, target) < 0) _exit(126);
}

}  // namespace

std::size_t Outcome::error_lines() const {
  std::size_t lines = 0;
  std::istringstream text(err);
  // hwloc, a part of MPI, complains in every process if there is no /sys, as in a bare chroot.
  for (std::string line; std::getline(text, line) && !text.eof();)
    lines += line.starts_with("[hwloc/") || line.starts_with("  ") ? 0 : 1;
  return lines;
}

std::vector<std::string> Outcome::own_lines() const {
  std::vector<std::string> lines;
  std::istringstream text(err);
  for (std::string line; std::getline(text, line);)
    if (line.find("tessera: ") != std::string::npos) lines.push_back(line);
  return lines;
}

std::string contents(const std::string& file) {
  const std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

namespace {

pid_t start(const std::vector<std::string>& command, const std::filesystem::path& standard_output,
            const std::filesystem::path& standard_error) {
  std::vector<char*> words;
  for (const auto& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    redirect(standard_output.c_str(), O_WRONLY | O_CREAT, STDOUT_FILENO);
    redirect(standard_error.c_str(), O_WRONLY | O_CREAT, STDERR_FILENO);
    execvp(words.front(), words.data());
    _exit(127);
  }
  return child;
}

int status_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

Outcome run(const std::vector<std::string>& command, const std::filesystem::path& standard_output) {
  const Folder folder;
  Outcome outcome;
  outcome.status = status_of(start(command, standard_output, folder / "err"));
  outcome.err = contents(folder / "err");
  return outcome;
}

/// Words of a file in /proc, which are terminated by zeros.
std::vector<std::string> words_of(const std::filesystem::path& file) {
  std::vector<std::string> words;
  std::istringstream text(contents(file));
  for (std::string word; std::getline(text, word, '\0');) words.push_back(word);
  return words;
}

}  // namespace

Running::Running(const std::vector<std::string>& command)
    : process_(start(command, folder_ / "out", folder_ / "err")) {}

Running::~Running() {
  if (process_ <= 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

Outcome Running::wait() {
  EXPECT_TRUE(test::await([&] { return !runs(); })) << "it hangs";
  return wait_or_kill();
}

Outcome Running::wait_or_kill() {
  constexpr int launcher_seconds = 30;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(launcher_seconds);
  while (runs() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (runs()) kill(process_, SIGKILL);
  Outcome outcome;
  outcome.status = status_of(std::exchange(process_, -1));
  outcome.out = contents(folder_ / "out");
  outcome.err = contents(folder_ / "err");
  return outcome;
}

bool Running::runs() const {
  siginfo_t state{};
  return process_ > 0 && waitid(P_PID, static_cast<id_t>(process_), &state, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         state.si_pid == 0;
}

ProcessState state_of(pid_t process) {
  ProcessState state;
  const std::string text = contents("/proc/" + std::to_string(process) + "/stat");
  std::istringstream words(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  std::string skipped;
  words >> state.letter >> state.parent;
  for (int k = 0; k < 9; ++k) words >> skipped;
  words >> state.ticks;
  return state;
}

std::map<int, pid_t> ranks_with(const std::string& word) {
  std::map<int, pid_t> ranks;
  std::error_code gone;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", gone)) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const auto command = words_of(entry.path() / "cmdline");
    // The process is a rank, or a shell that will exec the rank's program.
    if (std::none_of(command.begin(), command.end(), [&](const auto& w) { return w.find(word) != std::string::npos; }))
      continue;
    for (const std::string& variable : words_of(entry.path() / "environ"))
      for (const std::string known : {"OMPI_COMM_WORLD_RANK=", "PMI_RANK="})
        if (variable.starts_with(known)) ranks.emplace(std::stoi(variable.substr(known.size())), std::stoi(name));
  }
  return ranks;
}

Outcome tessera_to(const std::filesystem::path& standard_output, const std::vector<std::string>& arguments) {
  std::vector<std::string> command{TESSERA_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run(command, standard_output);
}

bool has_mpirun() {
  const Folder folder;
  return run({"mpirun", "--version"}, folder / "out").status == 0;
}

std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::string> mpirun_command(int ranks, const std::vector<std::string>& arguments) {
  // Allows runs as root and with more ranks than cores, as in a container. Leaks of Open MPI itself are not reported.
  std::vector<std::string> command{"env",
                                   "OMPI_ALLOW_RUN_AS_ROOT=1",
                                   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                                   "ASAN_OPTIONS=detect_leaks=0",
                                   "mpirun",
                                   "--oversubscribe",
                                   "-n",
                                   std::to_string(ranks),
                                   TESSERA_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

Outcome mpirun(int ranks, const std::vector<std::string>& arguments) {
  return Running(mpirun_command(ranks, arguments)).wait();
}

Outcome tessera(const std::vector<std::string>& arguments) {
  const Folder folder;
  Outcome outcome = tessera_to(folder / "out", arguments);
  outcome.out = contents(folder / "out");
  return outcome;
}

Folder::Folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "tessera-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

std::string Folder::file(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return *this / name;
}

std::string Folder::cube() const {
  const auto made = tessera({"generate", "cube", *this / "cube.vtu", "n=4", "--quiet"});
  EXPECT_EQ(made.status, 0) << made.err;
  return *this / "cube.vtu";
}

std::string Folder::rectilinear() const {
  std::string axis, samples;
  for (int i = 0; i < 12; ++i) axis += std::to_string(0.1 * i + 0.01 * i * i) + " ";
  for (int i = 0; i < 12 * 12 * 12; ++i) samples += std::to_string(i * i * 7 % 101) + " ";
  const std::string coordinates = "<DataArray type=\"Float64\" format=\"ascii\">" + axis + "</DataArray>";
  return file("a.vtr",
              "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\">"
              "<RectilinearGrid WholeExtent=\"0 11 0 11 0 11\"><Piece Extent=\"0 11 0 11 0 11\"><PointData>"
              "<DataArray type=\"Float32\" Name=\"f\" format=\"ascii\">" +
                  samples + "</DataArray></PointData><Coordinates>" + coordinates + coordinates + coordinates +
                  "</Coordinates></Piece></RectilinearGrid></VTKFile>");
}

}  // namespace tessera::apps
