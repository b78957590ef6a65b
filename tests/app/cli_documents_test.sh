#!/usr/bin/env bash
# The manual page and the shells' completions know every verb, and shells can read them. cli_documents_test.sh PROGRAM
set -eu
page=$("$1" --man)
bash_words=$("$1" --completion bash)
zsh_words=$("$1" --completion zsh)
verbs=$("$1" --help | sed -n '/^Subcommands:/,/^$/{s/^  \([a-z]\+\) .*/\1/p}')
[ "$(wc -w <<<"$verbs")" -ge 12 ] || { echo "--help names too few verbs: $verbs"; exit 1; }
for verb in $verbs; do
  grep -q "^\.SS $verb\$" <<<"$page" || { echo "the manual page has no $verb"; exit 1; }
  grep -q "^    $verb) options=" <<<"$bash_words" || { echo "bash's completion has no $verb"; exit 1; }
  grep -q "^    '$verb:" <<<"$zsh_words" || { echo "zsh's completion has no $verb"; exit 1; }
done
bash -n <<<"$bash_words"
offered=$(bash -c "$bash_words"'
COMP_WORDS=(driftwright diagnose --mea); COMP_CWORD=2; _driftwright; echo "${COMPREPLY[@]}"')
[ "$offered" = --measured ] || { echo "bash offers '$offered' for --mea"; exit 1; }
! "$1" --completion fish >/dev/null 2>&1 || { echo "an unknown shell is taken"; exit 1; }
