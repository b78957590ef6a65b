#!/bin/bash
# The archive where nothing but glibc is: no shell, no compiler, no network, no other library. It is unpacked in a root that holds the files of glibc alone,
# and the program does its main jobs there, with the numbers that it has here: archive_test.sh BUILD_FOLDER FOLDER_OF_THE_PROJECT [PYTHON]
set -eu
build=$(realpath "$1") top=$2 python=${3:-/usr/bin/python3}
skip() { echo "skipped: $*"; exit 77; }
fail() { echo "$*"; exit 1; }
for tool in patchelf dpkg-query "$python"; do command -v "$tool" >/dev/null || skip "$tool is not installed"; done
unshare --user --map-root-user --mount --pid --fork --net true 2>/dev/null || skip "this system does not allow namespaces of a user (unshare)"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/root
glibc=$(dirname "$(ldd "$BASH" | sed -n 's/.*libc\.so\.6 => \([^ ]*\).*/\1/p')")
mkdir -p "$root"/{opt,tmp,proc,dev,lib64} "$root$glibc"
cp -L /lib64/ld-linux-x86-64.so.2 "$root/lib64/"
for name in libc.so.6 libm.so.6 libmvec.so.1 libpthread.so.0 libdl.so.2 librt.so.1 libresolv.so.2; do cp -L "$glibc/$name" "$root$glibc/"; done
touch "$root/dev/null"

"$python" "$top/cmake/bundle.py" archive "$build" "$work"
tar xzf "$work"/driftwright-*.tar.gz -C "$root/opt"
unpacked=$(echo "$root"/opt/*)
here=/opt/$(basename "$unpacked")   # as the program in the root sees it

# bare ARGUMENTS: the program in the root.
bare() {
  unshare --user --map-root-user --mount --pid --fork --net -- bash -ec '
    mount -t proc proc "$1/proc"
    mount --bind /dev/null "$1/dev/null"
    exec env -i HOME=/tmp PATH=/nowhere "$(PATH=$PATH:/usr/sbin command -v chroot)" "$1" "${@:2}"' bare "$root" "$here/driftwright" "$@" || fail "in the bare root: driftwright $*"
}
# rows FILE: a record without the comments that name the scenario.
rows() { grep -v '^#' "$1"; }

began=$SECONDS
bare --version
bare predict "$here/scenarios/first_machine.yaml" --cyclogram shift -o /tmp/first >"$work/said"
grep -q 'nose_z *µm *85.0' "$work/said" || fail "README's first prediction: $(cat "$work/said")"
"$build/app/driftwright" predict "$top/scenarios/first_machine.yaml" --cyclogram shift -o "$work/first" --quiet
cmp <(rows "$root/tmp/first/record.csv") <(rows "$work/first/record.csv") || fail "another prediction than that of the build folder"
bare run "$here/scenarios/fp3_spindle.yaml" -o /tmp/fp3 >"$work/said"
grep -q 'Inside 10 µm by at least one strategy' "$work/said" || fail "README's main job: $(cat "$work/said")"
for file in report.html fields.pvd; do [ -s "$root/tmp/fp3/$file" ] || fail "run has written no $file"; done
echo "first prediction and main job: $((SECONDS - began)) s"

# A drawing (OpenCASCADE, Gmsh), fields in VTK, and in HDF5.
bare mesh "$here/scenarios/parts/vertical_mill.step" -o /tmp/mesh --quiet
[ -s "$root/tmp/mesh/mesh.vtu" ] || fail "mesh has written no mesh.vtu"
bare init /tmp/mill --from "$here/scenarios/parts/vertical_mill.step" >/dev/null
bare run /tmp/mill/mill.yaml -o /tmp/mill_run --quiet
cp -r "$unpacked/scenarios/" "$root/tmp/scenarios"
sed -i 's/fields_format: vtu/fields_format: xdmf/' "$root/tmp/scenarios/fp3_spindle.yaml"
bare simulate /tmp/scenarios/fp3_spindle.yaml --cyclogram warm_up_2000 -o /tmp/xdmf --quiet
[ -s "$root/tmp/xdmf/fields.h5" ] || fail "simulate has written no fields.h5"

# Records, judging, diagnosis.
records=$here/scenarios/records
bare import "$records/logger_file.csv" -o /tmp/import --quiet
bare identify --record "$records/monday.csv" --record "$records/tuesday.csv" -o /tmp/identified --quiet
bare validate "$here/scenarios/fp3_spindle.yaml" --train "$records/monday.csv" --test "$records/tuesday.csv" -o /tmp/validated --quiet
[ -s "$root/tmp/validated/report.html" ] || fail "validate has written no report"
bare simulate "$here/scenarios/lumped_spindle.yaml" --cyclogram shift -o /tmp/lumped --quiet
bare diagnose "$here/scenarios/lumped_spindle.yaml" --measured /tmp/lumped/record.csv -o /tmp/diagnosed >"$work/said"
grep -qi consistent "$work/said" || fail "diagnose: $(cat "$work/said")"

# For others: corrections in a part program, a page, units that need no compiler.
bare schedule "$here/scenarios/fp3_spindle.yaml" --program "$here/scenarios/parts/fp3_part.ngc" -o /tmp/part --quiet
bare follow "$here/scenarios/fp3_spindle.yaml" --replay "$records/monday.csv" >"$work/lines"
[ "$(wc -l <"$work/lines")" -gt 60 ] || fail "follow"
bare view "$here/scenarios/fp3_spindle.yaml" -o /tmp/twin.html >/dev/null
for fmi in 2 3; do bare export "$here/scenarios/fp3_spindle.yaml" --fmu --fmi $fmi -o /tmp/unit$fmi.fmu >/dev/null; done
[ -s "$root/tmp/unit2.fmu" ] && [ -s "$root/tmp/unit3.fmu" ] || fail "no functional mock-up unit"
echo "all jobs: $((SECONDS - began)) s"

# Every library's licence is there.
for licence in gmsh vtk9 openblas; do
  compgen -G "$unpacked/share/doc/driftwright/bundled/*$licence*/copyright" >/dev/null || fail "no licence of $licence"
done

# With a library missing it must say which, or this test would prove nothing.
mv "$unpacked/lib/libcholmod.so.3" "$work/"
if (bare --version) >"$work/said" 2>&1; then fail "the program runs without its libcholmod: it found another"; fi
grep -q 'libcholmod' "$work/said" || fail "$(cat "$work/said")"
mv "$work/libcholmod.so.3" "$unpacked/lib/"
# Gmsh is loaded when it is first needed.
mv "$unpacked/lib/libgmsh.so.4.8" "$work/"
bare --version >/dev/null || fail "the program does not begin without Gmsh"
if (bare mesh "$here/scenarios/parts/vertical_mill.step" -o /tmp/without) >"$work/said" 2>&1; then fail "it meshes without its libgmsh: it found another"; fi
grep -q 'cannot be loaded: libgmsh' "$work/said" || fail "$(cat "$work/said")"
mv "$work/libgmsh.so.4.8" "$unpacked/lib/"

# Another program links the library of the archive, where a compiler is.
cmake -S "$top/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$unpacked" >"$work/log" 2>&1 && cmake --build "$work/examples" >>"$work/log" 2>&1 ||
  { tail -n 30 "$work/log"; fail "the examples do not build against the archive"; }
"$work/examples/drift_of_a_day" "$top/scenarios/lumped_spindle.yaml" 12000 | grep -q '^nose_z over 50 shifts' || fail "drift_of_a_day"
echo "archive: all pass"
