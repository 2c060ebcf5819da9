// Scripts of `stiction completion`, without what follows from the commands: @COMMANDS@, @VALUES@ and @WORDS@.
#pragma once

#include <string_view>

namespace stiction::host {

// bash takes "=" for a word of its own, so that --machine=emps is three words.
inline constexpr std::string_view bash_completion =
    R"script(# Completion of stiction for bash, made by `stiction completion bash`.
_stiction() {
  local program=${COMP_WORDS[0]} current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local command='' machine='' word='' values='' takes='' first='' before='' i
  local -a options=() commands=()
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [[ $word == --machine || $word == --axes ]]; then
      machine=${COMP_WORDS[i + 1]}
      [[ $machine != = ]] || machine=${COMP_WORDS[i + 2]}
    fi
    case "$command/$word" in
@COMMANDS@
    esac
  done
  COMPREPLY=()
  case "$command $previous" in
@VALUES@
  esac
  case $command in
@WORDS@
  esac
  if [[ -z $takes ]]; then
    if [[ $current == -* ]]; then
      values="${options[*]}"
    elif ((${#commands[@]})); then
      values="${commands[*]}"
    else
      values=${first:-:nothing}
    fi
  fi
  # A list goes on behind its last comma.
  if [[ $current == *,* ]]; then before=${current%,*},; fi
  case $values in
    :nothing) ;;
    :file) compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
    :folder) compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
    :machine)
      mapfile -t COMPREPLY < <(compgen -W "$("$program" machine list 2>/dev/null)" -P "$before" -- "${current##*,}"
                               [[ -n $before ]] || compgen -f -X '!*.toml' -- "$current"
                               [[ -n $before ]] || compgen -d -S / -- "$current") ;;
    :axis)
      [[ -z $machine ]] ||
        mapfile -t COMPREPLY < <(compgen -W "$("$program" machine list --axes "${machine%%,*}" 2>/dev/null)" \
                                         -P "$before" -- "${current##*,}") ;;
    *) mapfile -t COMPREPLY < <(compgen -W "$values" -P "$before" -- "${current##*,}") ;;
  esac
}
complete -F _stiction stiction
)script";

inline constexpr std::string_view zsh_completion = R"script(#compdef stiction
# Completion of stiction for zsh, made by `stiction completion zsh`.
_stiction() {
  local program=$words[1] current=$words[CURRENT] previous=$words[CURRENT-1]
  local command='' machine='' word='' values='' takes='' first='' i
  local -a options commands names
  if [[ $current == --*=* ]]; then
    previous=${current%%=*}
    compset -P '*='
  fi
  for ((i = 2; i < CURRENT; ++i)); do
    word=$words[i]
    [[ $word != --machine && $word != --axes ]] || machine=$words[i+1]
    [[ $word != --machine=* ]] || machine=${word#*=}
    case "$command/$word" in
@COMMANDS@
    esac
  done
  case "$command $previous" in
@VALUES@
  esac
  case $command in
@WORDS@
  esac
  if [[ -z $takes ]]; then
    if [[ $current == -* ]]; then
      _describe option options
      return
    elif (($#commands)); then
      _describe command commands
      return
    fi
    values=${first:-:nothing}
  fi
  [[ $values == :file || $values == :folder ]] || compset -P '*,'
  case $values in
    :nothing) ;;
    :file) _files ;;
    :folder) _files -/ ;;
    :machine)
      names=(${(f)"$($program machine list 2>/dev/null)"})
      compadd -a names
      _files -g '*.toml' ;;
    :axis)
      [[ -z $machine ]] || names=(${(f)"$($program machine list --axes ${machine%%,*} 2>/dev/null)"})
      compadd -a names ;;
    *)
      names=(${=values})
      compadd -a names ;;
  esac
}
if [[ $funcstack[1] == _stiction ]]; then
  _stiction "$@"
else
  compdef _stiction stiction
fi
)script";

}  // namespace stiction::host
