# shellcheck shell=bash
# Numbered progress on stderr, for the scripts that source it. Set `steps` to their number first.
step_number=0
step_started=$SECONDS

# step WHAT: ends the step before, and says what comes.
step() {
  step_done
  step_number=$((step_number + 1))
  printf '[%d/%d] %s\n' "$step_number" "$steps" "$*" >&2
}

# How long the step took, and everything so far.
step_done() {
  if [[ $step_number -gt 0 ]]; then
    printf '      %s, %s in all\n' "$(minutes $((SECONDS - step_started)))" "$(minutes "$SECONDS")" >&2
  fi
  step_started=$SECONDS
}

minutes() {
  printf '%d:%02d min' $(($1 / 60)) $(($1 % 60))
}
