#!/bin/bash
# The library as another program meets it: installed, found, linked: installed_test.sh BUILD_FOLDER FOLDER_OF_THE_PROJECT
set -eu
build=$1 top=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/installed" >"$work/log" || { tail "$work/log"; exit 1; }
cmake -S "$top/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$work/installed" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Wpedantic -Werror" >"$work/log" 2>&1 &&
  cmake --build "$work/examples" >>"$work/log" 2>&1 || { tail -n 30 "$work/log"; exit 1; }
fail() { echo "$*"; exit 1; }
for example in "$top"/examples/*.cpp; do
  [ "$(wc -l <"$example")" -le 60 ] || fail "$example is longer than 60 lines"
done
cd "$top"
lumped=scenarios/lumped_spindle.yaml
"$work/examples/drift_of_a_day" $lumped 12000 | grep -Eq '^nose_z over 50 shifts: [0-9.]+ um in the middle' || fail "drift_of_a_day"
[ "$(yes '2000 20' | head -n 120 | "$work/examples/beside_a_control" scenarios/fp3_spindle.yaml | wc -l)" = 121 ] || fail "beside_a_control"
"$work/installed/bin/driftwright" simulate $lumped -o "$work/simulated" >/dev/null || fail "the installed program"
"$work/examples/what_is_wrong" $lumped "$work"/simulated/records/shift.csv >"$work/extended.yaml" 2>"$work/words" || fail "what_is_wrong: $(cat "$work/words")"
grep -q '^consistent: ' "$work/words" || fail "what_is_wrong: $(cat "$work/words")"
"$work/installed/bin/driftwright" check "$work/extended.yaml" >/dev/null || fail "extended.yaml"
"$work/installed/bin/driftwright" diagnose $lumped --measured "$work"/simulated/records/shift.csv -o "$work/diagnosed" >/dev/null || fail "diagnose"
cmp "$work/extended.yaml" "$work/diagnosed/extended.yaml" || fail "the library's extended scenario is not the program's"
# Nothing but the public names is shown: what another program links cannot clash with what is inside.
foreign=$(nm -D --defined-only --demangle "$work"/installed/lib/*/libdriftwright.so 2>/dev/null || nm -D --defined-only --demangle "$work"/installed/lib/libdriftwright.so)
echo "$foreign" | grep -E ' [TW] ' | grep -Ev ' (driftwright::|std::|typeinfo|vtable|void std::|guard|__gnu|operator|bool std::|decltype)' | head -n 5 | grep . && fail "these names are shown too"
echo "installed: all pass"
