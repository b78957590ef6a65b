#!/usr/bin/env bash
# What building costs: bench/build.sh [COMMIT] [-t TARGET]
# Processor seconds of the compilers a room, program and tests apart, their steps, and the ten dearest objects, each object built without a cache; with a
# COMMIT the same of that commit, and the ratio to it. Targets: all (default), or driftwright, the program alone. Takes as long as the builds do.
set -eu
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
command -v /usr/bin/time >/dev/null || { echo "bench/build.sh: please apt-get install time" >&2; exit 1; }
target=all commit=
while [ $# -gt 0 ]; do
  case "$1" in
    -t) target="$2"; shift 2 ;;
    -*) printf 'usage: bench/build.sh [COMMIT] [-t TARGET]\n' >&2; exit 2 ;;
    *) commit="$1"; shift ;;
  esac
done
work=$(mktemp -d "${TMPDIR:-/tmp}/driftwright_build.XXXXXX")
trap 'rm -rf "$work"; git -C "$top" worktree prune' EXIT

# The launcher of each compiler: "USER SYSTEM OBJECT" for the log.
cat >"$work/timed" <<'END'
#!/usr/bin/env bash
object=link
for ((i = 1; i < $#; ++i)); do [ "${!i}" = -o ] && { next=$((i + 1)); object="${!next}"; }; done
exec /usr/bin/time -q -a -o "$TIMES" -f "%U %S $object" "$@"
END
chmod +x "$work/timed"

# measured NAME TREE: builds the tree, writes NAME.times and prints the wall time.
measured() {
  local name="$1" tree="$2" began ended
  export TIMES="$work/$name.times"
  : >"$TIMES"
  cmake -G Ninja -S "$tree" -B "$work/$name" -DCMAKE_BUILD_TYPE=Release -DCCACHE_PROGRAM=OFF \
    -DCMAKE_CXX_COMPILER_LAUNCHER="$work/timed" -DCMAKE_C_COMPILER_LAUNCHER="$work/timed" >"$work/$name.log" 2>&1 ||
    { tail -n 20 "$work/$name.log" >&2; exit 1; }
  began=$(date +%s)
  ninja -C "$work/$name" "$target" >>"$work/$name.log" 2>&1 || { tail -n 40 "$work/$name.log" >&2; exit 1; }
  ended=$(date +%s)
  printf '%s: %s built in %d s on %d cores\n' "$name" "$target" $((ended - began)) "$(nproc)"
  # The room of an object: the folder before CMakeFiles, and for tests the target.
  awk '{ object = $3; room = object; sub(/\/CMakeFiles\/.*/, "", room)
         if (room == "tests") { room = object; sub(/.*CMakeFiles\//, "", room); sub(/\.dir\/.*/, "", room); room = "tests/" room }
         seconds[room] += $1 + $2; steps[room]++ }
       END { for (room in steps) printf "%s %.1f %d\n", room, seconds[room], steps[room] }' "$TIMES" | sort >"$work/$name.rooms"
  printf '\nDearest objects of %s [s]\n' "$name"
  awk '{ printf "%7.1f  %s\n", $1 + $2, $3 }' "$TIMES" | sort -rn | head -n 10
  printf '\n'
}

measured here "$top"
if [ -n "$commit" ]; then
  git -C "$top" worktree add -q --detach "$work/tree" "$commit"
  measured before "$work/tree"
else
  cp "$work/here.rooms" "$work/before.rooms"
fi
printf '%-44s %10s %6s %10s %6s %6s\n' room "here [s]" steps "before [s]" steps ratio
awk 'NR == FNR { s[$1] = $2; n[$1] = $3; next }
     function row(name, a, b, c, d) { printf "%-44s %10.1f %6d %10.1f %6d %6s\n", name, a, b, c, d, (c > 0 ? sprintf("%.2f", a / c) : "") }
     { row($1, $2, $3, s[$1], n[$1]); k = $1 ~ /^tests/ ? "tests" : "program"; a[k] += $2; b[k] += $3 }
     END { for (r in s) { k = r ~ /^tests/ ? "tests" : "program"; c[k] += s[r]; d[k] += n[r] }
           for (k in a) row("all of " k, a[k], b[k], c[k], d[k]) }' "$work/before.rooms" "$work/here.rooms"
