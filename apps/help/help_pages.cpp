// SPDX-License-Identifier: BSD-3-Clause
#include "apps/help/help_pages.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace tessera::apps {
namespace {

constexpr std::size_t columns = 100, left_column = 30;

/// Options of `render` by topic: first those of --help, then those of --help-all alone. What no topic names is under
/// "More".
struct Topic {
  const char *title, *first, *more;
};
constexpr std::array topics = {
    Topic{"Server", "", "bind port latency tls-certificate tls-key allow-host"},
    Topic{"Data", "field block clip threshold time-step",
          "labels scale smooth warp drop-duplicates q max-volume higher-order-tolerance higher-order-tets cut-planes"},
    Topic{"Raw volumes", "", "dims type spacing origin endian skip"},
    Topic{"Colour and opacity", "transfer-function range log opacity opacity-points background",
          "rescale unit-distance blend emission"},
    Topic{"View", "view zoom azimuth elevation camera size", "up fit projection orbit"},
    Topic{"Surfaces and light", "iso surface shade", "no-shade light"},
    Topic{"In the picture", "color-bar axes outline scale-bar annotate",
          "color-bar-title color-bar-range color-bar-scale field-unit length-unit annotation-color annotation-size "
          "annotation-layer"},
    Topic{"Output", "output orbit frame-rate report", "peel half png-bits resume timing progress quiet"},
    Topic{"Accuracy and speed", "accuracy threads memory verify",
          "preset integrator deep-accuracy rasterizer tile-size repeat without step brick-size edge-bricks "
          "cache preload"},
    Topic{"Devices", "", "compositor backend framebuffer egl-device"},
    Topic{"Under mpirun", "",
          "projectors compositors exchange partition frames-in-flight seed distribution direct-send balance "
          "balance-resolution balance-weights show stall-timeout on-stall"},
    Topic{"Settings in files", "like config save-config", ""},
};

bool holds(std::string_view list, std::string_view word) {
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t stop = std::min(list.find(' ', at), list.size());
    if (list.substr(at, stop - at) == word) return true;
    at = stop + 1;
  }
  return false;
}

bool named_in(const char* list, const CLI::Option& option) {
  return std::ranges::any_of(option.get_lnames(), [&](const std::string& name) { return holds(list, name); });
}

bool asks_for_help(const CLI::App& command, const CLI::Option* option) {
  return option == command.get_help_ptr() || option == command.get_help_all_ptr();
}

std::vector<const CLI::Option*> told_options(const CLI::App& command) {
  return command.get_options([&](const CLI::Option* option) {
    return option->nonpositional() && !option->get_group().empty() && !asks_for_help(command, option);
  });
}

/// Words into lines; a word that is too long stands alone.
std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines(1);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t stop = std::min(text.find(' ', at), text.size());
    const std::string_view word = text.substr(at, stop - at);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + std::string(word);
    at = stop + 1;
  }
  return lines;
}

/// The beginning that says what it is, where the whole does not fit.
std::string first_words(const std::string& description, std::size_t width) {
  if (description.size() <= width) return description;
  const std::size_t cut = std::min(description.find("; "), description.find(" ("));
  return description.substr(0, cut);
}

void add_entry(std::string& page, const std::string& form, const std::string& description) {
  const auto lines = wrapped(description, columns - left_column);
  page += "  " + form;
  const bool apart = form.size() + 4 > left_column;
  if (!apart) page.append(left_column - form.size() - 2, ' ');
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (apart || i > 0) page += "\n" + std::string(left_column, ' ');
    page += lines[i];
  }
  page += '\n';
}

}  // namespace

std::string usage_of(const CLI::App& command, const std::string& name) {
  std::string line = name + (command.get_parent() == nullptr ? " COMMAND" : " [OPTIONS]");
  for (const CLI::Option* word : command.get_options([](const CLI::Option* o) { return o->get_positional(); })) {
    const std::string form = word->get_name(true) + (word->get_expected_max() > 1 ? "..." : "");
    line += word->get_required() ? " " + form : " [" + form + "]";
  }
  return line;
}

namespace {

void add_commands(std::string& page, const CLI::App& app) {
  page += "\nCommands:\n";
  for (const CLI::App* command : app.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); }))
    add_entry(page, command->get_name(), command->get_description());
}

}  // namespace

std::vector<HelpTopic> help_topics(const CLI::App& command, bool all) {
  auto options = told_options(command);
  std::vector<HelpTopic> result;
  if (command.get_name() != "render" && command.get_name() != "serve") {
    if (!options.empty()) result.push_back({"Options", std::move(options)});
    return result;
  }
  for (const Topic& topic : topics) {
    HelpTopic shown{topic.title, {}};
    for (const CLI::Option*& option : options) {
      if (option == nullptr || !(named_in(topic.first, *option) || (all && named_in(topic.more, *option)))) continue;
      shown.options.push_back(option);
      option = nullptr;
    }
    if (!shown.options.empty()) result.push_back(std::move(shown));
  }
  std::erase(options, nullptr);
  if (all && !options.empty()) result.push_back({"More", std::move(options)});
  return result;
}

std::string option_form(const CLI::Option& option, bool all) {
  std::string form;
  for (const auto& name : option.get_snames()) form += (form.empty() ? "-" : ", -") + name;
  for (const auto& name : option.get_lnames()) {
    form += (form.empty() ? "--" : ", --") + name;
    if (!all) break;
  }
  if (option.get_type_size() == 0) return form;
  std::string type = option.get_type_name();
  const std::size_t room = left_column > form.size() + 5 ? left_column - form.size() - 5 : 0;
  if (!all && type.size() > room && type.find('|') != std::string::npos) {
    const std::size_t bar = type.rfind('|', room >= 4 ? room - 4 : 0);
    type = bar == std::string::npos ? "WORD" : type.substr(0, bar + 1) + "...";
  }
  return form + " " + type;
}

std::vector<std::string> help_examples(const CLI::App& command) {
  const std::string& name = command.get_name();
  if (name == "render")
    return {"tessera render mesh.vtu -o picture.png", "tessera render head.nii.gz --view left --color-bar -o head.png",
            "tessera render mesh.vtu --field p --transfer-function viridis --orbit 120 -o turn.mp4"};
  if (name == "serve") return {"tessera serve mesh.vtu", "mpirun -n 4 tessera serve mesh.pvtu --port 8080"};
  if (name == "info") return {"tessera info mesh.vtu"};
  if (name == "convert") return {"tessera convert mesh.vtu mesh.tets"};
  if (name == "generate") return {"tessera generate cube cube.vtu n=16"};
  return {};
}

std::string HelpPages::make_help(const CLI::App* command, std::string name, CLI::AppFormatMode mode) const {
  const bool is_render = command->get_name() == "render";
  const bool all = !is_render || mode != CLI::AppFormatMode::Normal;
  std::string page = command->get_description() + "\nUsage: " + usage_of(*command, name) + '\n';
  for (const std::string& example : help_examples(*command)) page += "  " + example + '\n';
  const auto positionals = command->get_options([](const CLI::Option* o) { return o->get_positional(); });
  if (!positionals.empty()) page += '\n';
  for (const CLI::Option* word : positionals)
    add_entry(page, word->get_name(true),
              all ? word->get_description() : first_words(word->get_description(), 2 * (columns - left_column)));
  if (command->get_parent() == nullptr) add_commands(page, *command);
  for (const HelpTopic& topic : help_topics(*command, all)) {
    page += fmt::format("{}{}:\n", all ? "\n" : "", topic.title);
    for (const CLI::Option* option : topic.options)
      add_entry(page, option_form(*option, all),
                all ? option->get_description() : first_words(option->get_description(), columns - left_column));
  }
  if (is_render)
    page += all ? "\nThe guide, docs/GUIDE.md, goes by what you want to do.\n"
                : "--help-all has all options, `tessera formats` the files that are read.\n";
  else if (command->get_parent() == nullptr)
    page += "\n`tessera help COMMAND` says more.\n";
  if (const std::string footer = command->get_footer(); !footer.empty()) page += '\n' + footer + '\n';
  return page;
}

}  // namespace tessera::apps
