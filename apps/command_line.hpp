// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/commands/chart_command.hpp"
#include "apps/commands/serve_command.hpp"
#include "apps/options/render_options.hpp"
#include "apps/options/stall_options.hpp"

namespace tessera::apps {

/// Every subcommand with its options, and the words that were given: the one declaration that parsing, help, manual
/// pages and completion are made from.
struct CommandLine {
  CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Of a subcommand, null for another word.
  [[nodiscard]] CLI::App* command(const std::string& name) const;
  /// Those that a user is told of, in the order of help.
  [[nodiscard]] std::vector<CLI::App*> commands() const;

  RenderWords words;
  StallWords stalls;
  ChartWords chart_words;
  ServeWords serve_words;
  bool as_json = false, check = false;
  std::string mesh_output, pieces, pieces_partition = "curve", subdivide = "0";
  std::string kind;
  std::vector<std::string> parameters;
  std::vector<std::string> traces;
  std::string csv, figure;
  std::string help_of, shell, picture;
  bool help_all = false, manual = false;

  CLI::App app;
  CLI::App *render, *serve, *info, *convert, *generate, *chart, *timing, *formats, *presets, *help, *completion;

 private:
  void declare_convert();
  void declare_generate();
  void declare_timing();
  void declare_help();
};

}  // namespace tessera::apps
