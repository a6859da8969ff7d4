// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/serve_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/commands/serve_scene.hpp"
#include "apps/render/progress.hpp"
#include "server/serve.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/output_file.hpp"

namespace tessera::apps {
namespace {

server::ServeOptions serve_options(const OptionWords& words) {
  server::ServeOptions options;
  if (words.given("bind")) options.network.address = words.word("bind");
  assign(options.network.port, words.count("port", 0, 65535));
  options.network.certificate = words.word("tls-certificate");
  options.network.key = words.word("tls-key");
  if (words.given("tls-certificate") != words.given("tls-key"))
    throw bad_input("--tls-certificate: it needs --tls-key, and --tls-key needs it; give both or neither");
  options.allowed_hosts = words.words("allow-host");
  assign(options.renderer.latency_ms, words.positive("latency"));
  assign(options.renderer.threads, words.count("threads", 1, 1024));
  assign(options.renderer.memory_bytes, words.bytes("memory"));
  return options;
}

}  // namespace

void serve(const OptionWords& words, Job& job) {
  const server::ServeOptions options = serve_options(words);
  require_input(words.word("input"));
  const auto reader = scene_reader(words, job);
  static_cast<void>(reader->scene(server::Json::object()));  // reports errors in the options now
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
    Job::print_once("tessera: a rank was lost or ended from outside; start the server again");
    std::_Exit(static_cast<int>(ErrorCode::system_failure));
  };
  server::serve(options, *reader, job, events);
}

}  // namespace tessera::apps
