#compdef maploop maploop-vehicle
# Completion of maploop's subcommands and options, as its own --help lists them.
_maploop() {
  local program=$words[1] word help
  local -a given subcommands options
  # The subcommand, and that of `map`, `log`, `gnss` or `experiment`.
  for word in ${words[2,CURRENT-1]}; do
    [[ $word == [a-z]* && $word != */* && $#given -lt 2 ]] || break
    given+=$word
  done
  help=$($program $given --help 2>/dev/null) || help=$($program $given[1] --help 2>/dev/null)
  subcommands=(${(f)"$(sed -n '/^Subcommands:/,$s/^  \([a-z][a-z-]*\) \+\(.*\)/\1:\2/p' <<<$help)"})
  options=(${(fu)"$(grep -o -- '--[a-z][a-z-]*' <<<$help | sort)"})
  if [[ $words[CURRENT] == -* ]]; then
    compadd -- $options
  elif (( $#subcommands )); then
    _describe subcommand subcommands
  else
    _files
  fi
}
_maploop "$@"
