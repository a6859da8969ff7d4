// SPDX-License-Identifier: BSD-3-Clause
// The `tessera` program: subcommands over the libraries. Every error ends here, as one line on stderr and an exit
// status (ExitCode).

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/commands/chart_command.hpp"
#include "apps/commands/convert_command.hpp"
#include "apps/commands/formats_command.hpp"
#include "apps/commands/generate_command.hpp"
#include "apps/commands/info_command.hpp"
#include "apps/commands/presets_command.hpp"
#include "apps/commands/serve_command.hpp"
#include "apps/commands/timing_command.hpp"
#include "apps/interruption.hpp"
#include "apps/options/stall_options.hpp"
#include "apps/parse_arguments.hpp"
#include "apps/render/film.hpp"
#include "apps/standard_streams.hpp"
#include "tessera/input_file.hpp"
#include "tessera/job.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/program/printable.hpp"
#include "tessera/program/render_options.hpp"

namespace tessera::apps {
namespace {

/// Prints an error as one line, even if file names or messages contain line breaks, with names of options instead of
/// settings. Prints nothing if the run's error has already been printed.
int fail(const Error& error) {
  yield_to_interruption();
  std::string line = "tessera: " + printable(with_stream_names(with_options(error.what())));
  while (line.ends_with(' ')) line.pop_back();
  // A name or a value that was read from a file may be as long as the file.
  constexpr std::size_t longest = 3000, half = 1000;
  if (line.size() > longest) line = line.substr(0, half) + " ... " + line.substr(line.size() - half);
  Job::print_once(line);
  return static_cast<int>(error.code());
}

/// Whether a rectilinear grid, which is opened as a volume by default, should be converted as a mesh.
bool to_mesh(const InputFile& input, const std::filesystem::path& output) {
  const auto extension = output.extension();
  return (extension == ".vtu" || extension == ".tets" || extension == ".pvtu") && input.opens_as_mesh();
}

ExitCode render_words(OptionWords& words, Job& job) {
  const std::string given = words.state().toml();
  apply_like(words);
  apply_method_preset(job.size(), words);
  RenderOptions options = render_options(words);
  options.scene = given;
  options.progress = !options.quiet && (options.progress || isatty(STDERR_FILENO) == 1);
  if (options.to_standard_output) require_no_terminal("-o");
  if (const auto stalls = stall_settings(words, options.quiet)) job.watch_stalls(*stalls);
  return render(options, job);
}

ExitCode run(int argc, char** argv, Job& job) {
  // Signals are the normal end of a server.
  const bool serves = argc > 1 && std::string_view(argv[1]) == "serve";
  if (job.size() == 1 && !serves) answer_interruption();
  if (!serves) job.answer_termination();
  job.agree_instruction_sets();
  protect_inputs();

  std::optional<Arguments> arguments = parse_arguments(argc, argv, job.rank() == 0);
  if (!arguments) return ExitCode::complete;
  OptionWords& words = arguments->words;
  const Trait command = arguments->command->trait;

  if (command != Trait::render) refuse_time_steps(words);
  if (words.word("input") == standard_stream) {
    if (job.size() > 1)
      throw bad_input("standard input: only one process can read it; give a file that all processes can open");
    words.set("input", spool_standard_input().string());
  }
  if (command == Trait::render) return render_words(words, job);
  if (command == Trait::serve) {
    if (const auto stalls = stall_settings(words, false)) job.watch_stalls(*stalls);
    serve(words, job);
    return ExitCode::complete;
  }
  if (job.rank() != 0) return ExitCode::complete;  // the other commands use one process
  const std::string &input = words.word("input"), &output = words.word("out");
  if (command == Trait::info) {
    const InputFile first = first_input(words);
    const bool is_grid = draws_grids(words, first);
    if (words.given("check") && is_grid) {
      require_input(input);
      throw bad_input("--check: it is for meshes, but the input is a volume; leave it out");
    }
    ReadOptions options = read_options(words, is_grid);
    options.shape = !is_grid;  // as `render` does without options
    info(input, first, options, words.given("json"), words.given("check"));
  }
  if (command == Trait::convert) {
    if (is_time_series(input)) require_input(input);  // reports an error if the files of a list are missing
    const InputFile file(input);
    if (is_grid_input(words, file) && !to_mesh(file, output)) {
      ReadOptions options = read_options(words, true);
      options.blocks.clear();  // for volumes the option is the side length of a block
      convert_grid(file, output, options, words.count("block", 8, 1024).value_or(64), words.given("quiet"));
    } else {
      convert_mesh(file, output, read_options(words, false), words.count("subdivide", 0, 8).value_or(0),
                   convert_pieces(words), words.given("quiet"));
    }
  }
  if (command == Trait::chart) chart(words);
  if (command == Trait::formats) formats(words.given("json"));
  if (command == Trait::presets) presets(words.word("output"));
  if (command == Trait::timing)
    timing({words.words("trace").begin(), words.words("trace").end()}, words.word("csv"), words.word("figure"));
  if (command == Trait::generate) generate(words.word("kind"), output, words.words("parameters"), words.given("quiet"));
  return ExitCode::complete;
}

}  // namespace
}  // namespace tessera::apps

namespace {

using tessera::Error;
using tessera::ErrorCode;
using tessera::apps::ExitCode;

/// Returns the current exception as an error for the user.
Error as_error() {
  try {
    throw;
  } catch (const tessera::OutputFault& fault) {
    return fault.since_changed();  // every command has checked its outputs before it began
  } catch (...) {
    return tessera::error_of(std::current_exception());
  }
}

/// Reports an uncaught exception, for example on a thread of oneTBB that cannot start another one.
[[noreturn]] void on_terminate() {
  static std::atomic<bool> again = false;
  if (std::current_exception() == nullptr || again.exchange(true)) std::abort();
  const Error error = as_error();
  tessera::apps::fail(error);
  std::_Exit(static_cast<int>(error.code()));
}

/// Opens /dev/null for each standard stream that the caller has closed. Otherwise the next file to be opened would get
/// the stream's number, and messages would be written to it. Standard output is opened for reading, so that writing a
/// result to it fails.
void fill_standard_descriptors() {
  for (const auto& [descriptor, how] :
       {std::pair{STDIN_FILENO, O_RDONLY}, std::pair{STDOUT_FILENO, O_RDONLY}, std::pair{STDERR_FILENO, O_WRONLY}})
    if (::fcntl(descriptor, F_GETFD) < 0) static_cast<void>(::open("/dev/null", how));
}

/// Throws if the limit of the stack is so small that the stack of a thread could overflow during a frame.
void require_stack() {
  constexpr rlim_t least = 1 << 20;
  rlimit limit{};
  if (::getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= least) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 8 * least);
  if (limit.rlim_cur < least || ::setrlimit(RLIMIT_STACK, &limit) != 0)
    throw Error(ErrorCode::system_failure, "stack",
                std::to_string(limit.rlim_cur / 1024) + " KiB are too few, and this process is not allowed more",
                "ulimit -s 8192");
}

/// Makes the stack of the first thread grow to more than rendering needs. Stacks grow on demand. If the address space
/// is limited, growing may fail later, and the system then kills the process without a message.
[[gnu::noinline]] void grow_stack() {
  std::array<volatile char, 1 << 19> room;  // NOLINT(cppcoreguidelines-pro-type-member-init): touched below
  for (std::size_t byte = 0; byte < room.size(); byte += 4096) room[byte] = 0;
}

}  // namespace

int main(int argc, char** argv) {
  using tessera::apps::fail;
  fill_standard_descriptors();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that becomes too large is reported as an ordinary error
  std::optional<tessera::Job> job;
  try {
    require_stack();
    grow_stack();
    std::set_terminate(on_terminate);
    constexpr auto remedy = "finished images are kept, and the same command with --resume continues from there";
    const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    job.emplace(tessera::JobReporting{"tessera", remedy, [](const Error& error) { fail(error); }, arguments});
  } catch (...) {
    return fail(as_error());
  }
  ExitCode code = ExitCode::complete;
  try {
    code = tessera::apps::run(argc, argv, *job);
    // A result that could not be written (a full disk behind `>`) is an error.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      throw Error(ErrorCode::system_failure,
                  "standard output: it cannot be written; free disk space, or keep the reading program open");
  } catch (...) {
    job->fail(as_error());
  }
  if (const std::optional<Error> error = job->finish()) return static_cast<int>(error->code());
  return static_cast<int>(code);
}
