// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/serve_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/commands/serve_scene.hpp"
#include "apps/options/argument_values.hpp"
#include "apps/render/progress.hpp"
#include "server/serve.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/output_file.hpp"

namespace tessera::apps {
namespace {

server::ServeOptions serve_options(const RenderWords& words, const ServeWords& serve) {
  server::ServeOptions options;
  options.network.address = serve.bind;
  if (!serve.port.empty())
    options.network.port = static_cast<std::uint16_t>(parse_count("--port", serve.port, 0, 65535));
  options.network.certificate = serve.certificate;
  options.network.key = serve.key;
  if (serve.certificate.empty() != serve.key.empty())
    throw bad_input("--tls-certificate: it needs --tls-key, and the other way round; give both, or none");
  options.allowed_hosts = serve.allowed_hosts;
  options.renderer.latency_ms = parse_positive("--latency", serve.latency);
  if (!words.threads.empty()) options.renderer.threads = parse_count("--threads", words.threads, 1, 1024);
  if (!words.memory.empty()) options.renderer.memory_bytes = parse_bytes("--memory", words.memory);
  return options;
}

}  // namespace

void add_serve_options(CLI::App& command, RenderWords& words, ServeWords& serve) {
  command.add_option("--bind", serve.bind, "address to listen at (default: 127.0.0.1, this machine alone)")
      ->type_name("ADDRESS");
  command.add_option("--port", serve.port, "to listen at (default: a free one)")->type_name("PORT");
  command
      .add_option("--latency", serve.latency,
                  "while something moves: milliseconds from event to picture that sizes are chosen for (default 100)")
      ->type_name("MS");
  command.add_option("--tls-certificate", serve.certificate, "PEM file: speak https")->type_name("FILE");
  command.add_option("--tls-key", serve.key, "PEM file of its key")->type_name("FILE");
  command
      .add_option("--allow-host", serve.allowed_hosts,
                  "a name in the browser's address, beside loopback and --bind; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_scene_reader_options(command, words);
}

void serve(const RenderWords& words, const ServeWords& serve_words, const CLI::App& command, Job& job) {
  const server::ServeOptions options = serve_options(words, serve_words);
  require_input(words.input);
  const auto reader = scene_reader(words, command, job);
  static_cast<void>(reader->scene(server::Json::object()));  // what its words have wrong is said now
  server::ServeEvents events;
  events.listening = [](const std::string& url) {
    fmt::print("{}\n", url);
    std::fflush(stdout);
    if (shows_progress(false)) fmt::print(stderr, "Open this address in a browser; Ctrl-C ends the server.\n");
  };
  events.ended_at_work = [] {
    abandon_outputs();
    std::fflush(stdout);
    std::_Exit(0);
  };
  events.hurried = [](int signal) {
    abandon_outputs();
    std::_Exit(128 + signal);
  };
  events.rank_lost = [] {
    abandon_outputs();
    Job::say_once("tessera: a rank is lost, or was ended from outside; start the server again");
    std::_Exit(static_cast<int>(ErrorCode::system_failure));
  };
  server::serve(options, *reader, job, events);
}

}  // namespace tessera::apps
