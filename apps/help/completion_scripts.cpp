// SPDX-License-Identifier: BSD-3-Clause
// The scripts contain no options: they pass the words up to the cursor to the program named on the command line.

#include <fmt/format.h>

#include "apps/help/completion.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {
namespace {

// bash splits words at : and =. The script therefore joins them again and removes from each completion the part that
// bash already has.
constexpr const char* bash_script = R"script(# Completion of tessera for bash.
_tessera() {
  local word words=() found=() glued="" current given i
  for ((i = 1; i <= COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    if [[ ${#words[@]} -gt 0 && ( $word == [:=]* || $glued ) ]]; then
      words[-1]+=$word
    else
      words+=("$word")
    fi
    [[ $word == *[:=] ]] && glued=1 || glued=""
  done
  current=${words[-1]}
  given=${current%"${current##*[:=]}"}
  mapfile -t found < <("${COMP_WORDS[0]}" complete "${words[@]}" 2> /dev/null)
  COMPREPLY=()
  if [[ ${found[0]} == :files ]]; then
    found=("${found[@]:1}")
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "${current##*[:=]}")
    for word in "${found[@]}"; do COMPREPLY+=("${word#"$given"}"); done
  else
    for word in "${found[@]}"; do COMPREPLY+=("$(printf '%q' "${word#"$given"}")"); done
  fi
}
complete -F _tessera tessera
)script";

constexpr const char* zsh_script = R"script(#compdef tessera
# Completion of tessera for zsh.
_tessera() {
  local -a found
  found=("${(@f)$("${words[1]}" complete "${(@)words[2,CURRENT]}" 2> /dev/null)}")
  if [[ ${found[1]} == :files ]]; then
    found=("${(@)found[2,-1]}")
    if [[ ${words[CURRENT]} == --*=* ]]; then
      compset -P '*='
      found=("${(@)found#*=}")
    fi
    _files
  fi
  [[ -n ${found[1]} ]] && compadd -- "${found[@]}"
}
if [[ ${funcstack[1]} == _tessera ]]; then _tessera "$@"; else compdef _tessera tessera; fi
)script";

constexpr const char* fish_script = R"script(# Completion of tessera for fish.
function __tessera_complete
  set -l words (commandline -opc)
  set -l current (commandline -ct)
  if string match --quiet --regex '^["\']' -- "$current"
    set current (string sub --start 2 -- "$current")
  else
    set current (string unescape -- "$current")
  end
  set -l found ($words[1] complete $words[2..-1] "$current" 2> /dev/null)
  if test "$found[1]" = ":files"
    set -e found[1]
    set -l option (string match --regex '^--[^=]*=' -- "$current")
    for file in (__fish_complete_path (string replace -- "$option" "" "$current"))
      echo "$option$file"
    end
  end
  printf '%s\n' $found
end
complete -c tessera -f -a '(__tessera_complete)'
)script";

}  // namespace

std::string completion_script(const std::string& shell) {
  if (shell == "bash") return bash_script;
  if (shell == "zsh") return zsh_script;
  if (shell == "fish") return fish_script;
  throw bad_input(fmt::format("completion: '{}' is unknown; use bash, zsh or fish", shell));
}

}  // namespace tessera::apps
