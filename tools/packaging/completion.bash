# Completion of maploop's subcommands and options, as its own --help lists them.
_maploop() {
  local word=${COMP_WORDS[COMP_CWORD]} program=${COMP_WORDS[0]} given=() help
  local i
  # The subcommand, and that of `map`, `log`, `gnss` or `experiment`.
  for ((i = 1; i < COMP_CWORD && i <= 2; ++i)); do
    [[ ${COMP_WORDS[i]} == [a-z]* && ${COMP_WORDS[i]} != */* ]] || break
    given+=("${COMP_WORDS[i]}")
  done
  help=$("$program" "${given[@]}" --help 2>/dev/null) || help=$("$program" "${given[0]}" --help 2>/dev/null)
  local subcommands options
  subcommands=$(sed -n '/^Subcommands:/,$s/^  \([a-z][a-z-]*\) .*/\1/p' <<<"$help")
  options=$(grep -o -- '--[a-z][a-z-]*' <<<"$help" | sort -u)
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ -n $subcommands ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$subcommands" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -o filenames -F _maploop maploop maploop-vehicle
