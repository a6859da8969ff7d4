// SPDX-License-Identifier: BSD-3-Clause
// The `tessera` program: subcommands over the libraries. Everything that goes wrong ends here, in one line on stderr
// and an exit status (ExitCode).

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

#include "apps/command_line.hpp"
#include "apps/commands/chart_command.hpp"
#include "apps/commands/convert_command.hpp"
#include "apps/commands/formats_command.hpp"
#include "apps/commands/generate_command.hpp"
#include "apps/commands/info_command.hpp"
#include "apps/commands/presets_command.hpp"
#include "apps/commands/serve_command.hpp"
#include "apps/commands/timing_command.hpp"
#include "apps/interruption.hpp"
#include "apps/options/argument_values.hpp"
#include "apps/options/like_report.hpp"
#include "apps/options/method_preset.hpp"
#include "apps/options/render_options.hpp"
#include "apps/options/setting_words.hpp"
#include "apps/options/stall_options.hpp"
#include "apps/options/time_options.hpp"
#include "apps/options/volume_options.hpp"
#include "apps/parse_arguments.hpp"
#include "apps/render/film.hpp"
#include "apps/standard_streams.hpp"
#include "tessera/input_file.hpp"
#include "tessera/job.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/program/printable.hpp"
#include "tessera/time_series.hpp"

namespace tessera::apps {
namespace {

/// One line whatever the message holds: file names may contain line breaks, and libraries' messages do. Nothing if the
/// run's line has been said. Settings are options in it.
int fail(const Error& error) {
  yield_to_interruption();
  std::string line = "tessera: " + printable(with_stream_names(with_options(error.what())));
  while (line.ends_with(' ')) line.pop_back();
  // A name or a value from a file may be as long as the file.
  constexpr std::size_t longest = 3000, half = 1000;
  if (line.size() > longest) line = line.substr(0, half) + " ... " + line.substr(line.size() - half);
  Job::say_once(line);
  return static_cast<int>(error.code());
}

/// Whether a rectilinear grid, which is a volume, is asked for as the mesh that it is too.
bool to_mesh(const std::filesystem::path& input, const std::filesystem::path& output) {
  const auto extension = output.extension();
  return (extension == ".vtu" || extension == ".tets" || extension == ".pvtu") && opens_as_mesh(input);
}

ExitCode run(int argc, char** argv, Job& job) {
  // A server ends by a signal as it is meant to.
  const bool serves = argc > 1 && std::string_view(argv[1]) == "serve";
  if (job.size() == 1 && !serves) answer_interruption();
  if (!serves) job.answer_termination();
  job.agree_instruction_sets();
  protect_inputs();

  CommandLine line;
  RenderWords& words = line.words;
  if (!parse(line, argc, argv, job.rank() == 0)) return ExitCode::complete;

  if (!*line.render) refuse_time_steps(words.time_step);
  if (words.input == standard_stream) {
    if (job.size() > 1) throw bad_input("standard input: only one process has it; give a file that all can open");
    words.input = spool_standard_input().string();
  }
  if (*line.render) {
    apply_like(*line.render, words);
    apply_method_preset(*line.render, job.size(), words);
    const RenderOptions options = render_options(words);
    if (const auto stalls = stall_settings(line.stalls, words.quiet)) job.watch_stalls(*stalls);
    if (options.is_grid()) refuse_mesh_options(words, options);
    return render(options, job);
  }
  if (*line.serve) {
    if (const auto stalls = stall_settings(line.stalls, false)) job.watch_stalls(*stalls);
    serve(words, line.serve_words, *line.serve, job);
    return ExitCode::complete;
  }
  if (job.rank() != 0) return ExitCode::complete;  // the other commands are for one process
  if (*line.info) {
    const bool is_grid = is_time_series(words.input) ? draws_grids(words) : is_grid_input(words);
    if (line.check && is_grid) {
      require_input(words.input);
      throw bad_input("--check: is for meshes, and the input is a volume; leave it out");
    }
    ReadOptions options = is_grid ? volume_options(words) : mesh_options(words);
    options.shape = !is_grid;  // as render without options
    info(words.input, options, line.as_json, line.check);
  }
  if (*line.convert) require_input(words.input);
  if (*line.convert && is_grid_input(words) && !to_mesh(words.input, line.mesh_output)) {
    ReadOptions options = volume_options(words);
    const std::string side = options.blocks.empty() ? "64" : options.blocks.back();
    options.blocks.clear();
    convert_grid(words.input, line.mesh_output, options, parse_count("--block", side, 8, 1024), words.quiet);
  } else if (*line.convert) {
    convert_mesh(words.input, line.mesh_output, mesh_options(words), parse_count("--subdivide", line.subdivide, 0, 8),
                 convert_pieces(line.pieces, line.pieces_partition), words.quiet);
  }
  if (*line.chart) chart(words, line.chart_words);
  if (*line.formats) formats(line.as_json);
  if (*line.presets) presets(line.picture);
  if (*line.timing) timing({line.traces.begin(), line.traces.end()}, line.csv, line.figure);
  if (*line.generate) generate(line.kind, line.mesh_output, line.parameters, words.quiet);
  return ExitCode::complete;
}

}  // namespace
}  // namespace tessera::apps

namespace {

using tessera::Error;
using tessera::ErrorCode;
using tessera::apps::ExitCode;

/// What any exception is to the user.
Error as_error() {
  try {
    throw;
  } catch (const tessera::OutputFault& fault) {
    return fault.since_changed();  // every command has looked at its outputs before it began
  } catch (...) {
    return tessera::error_of(std::current_exception());
  }
}

/// An exception that nobody caught: on a thread of oneTBB's, say, which cannot start another.
[[noreturn]] void on_terminate() {
  static std::atomic<bool> again = false;
  if (std::current_exception() == nullptr || again.exchange(true)) std::abort();
  const Error error = as_error();
  tessera::apps::fail(error);
  std::_Exit(static_cast<int>(error.code()));
}

/// Opens /dev/null for each standard stream that the caller has closed. Otherwise the next file that is opened would
/// get the stream's number, and messages would be written into it. Standard output is opened to read, so that writing a
/// result to it fails.
void fill_standard_descriptors() {
  for (const auto& [descriptor, how] :
       {std::pair{STDIN_FILENO, O_RDONLY}, std::pair{STDOUT_FILENO, O_RDONLY}, std::pair{STDERR_FILENO, O_WRONLY}})
    if (::fcntl(descriptor, F_GETFD) < 0) static_cast<void>(::open("/dev/null", how));
}

/// Below this the first thread's stack may end in mid-frame, and the threads' with it.
void require_stack() {
  constexpr rlim_t least = 1 << 20;
  rlimit limit{};
  if (::getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= least) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 8 * least);
  if (limit.rlim_cur < least || ::setrlimit(RLIMIT_STACK, &limit) != 0)
    throw Error(ErrorCode::system_failure, "stack",
                std::to_string(limit.rlim_cur / 1024) + " KiB are all that this process may have", "ulimit -s 8192");
}

/// The first thread's stack grows as it is used. Where address space is limited there may be no room when it does, and
/// the system ends the process without a word; so it grows now, to more than rendering takes of it.
[[gnu::noinline]] void grow_stack() {
  std::array<volatile char, 1 << 19> room;  // NOLINT(cppcoreguidelines-pro-type-member-init): touched below
  for (std::size_t byte = 0; byte < room.size(); byte += 4096) room[byte] = 0;
}

}  // namespace

int main(int argc, char** argv) {
  using tessera::apps::fail;
  fill_standard_descriptors();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error as any other
  std::optional<tessera::Job> job;
  try {
    require_stack();
    grow_stack();
    std::set_terminate(on_terminate);
    constexpr auto remedy = "finished pictures stay, and the same command with --resume goes on from there";
    const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    job.emplace(tessera::JobVoice{"tessera", remedy, [](const Error& error) { fail(error); }, arguments});
  } catch (...) {
    return fail(as_error());
  }
  ExitCode code = ExitCode::complete;
  try {
    code = tessera::apps::run(argc, argv, *job);
    // A result that did not reach its reader (a full disk behind `>`) is not a success.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      throw Error(ErrorCode::system_failure, "standard output: cannot be written; make room or close the pipe later");
  } catch (...) {
    job->fail(as_error());
  }
  if (const std::optional<Error> error = job->finish()) return static_cast<int>(error->code());
  return static_cast<int>(code);
}
