#!/usr/bin/env bash
# bench/peers/run.sh [-w FOLDER] [-2] SIZE...: the same 300 minutes on the same meshes by Driftwright, FreeFEM, FEniCSx, CalculiX.
#
#   bench/peers/run.sh 20000 97000          meshes of about so many nodes of linear tetrahedra; -2: of quadratic ones
#
# Needs freefem++, python3-dolfinx, calculix-ccx, libopenblas0-serial, python3-gmsh, python3-numpy and time (Debian 12); none of
# them is a package of Driftwright but OpenBLAS. Without it FreeFEM takes twice as long. One run at a time: keep the machine quiet.
# Prints one table of all meshes: times with errors beside them. table.csv and the logs are beside each mesh.
set -eu
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../.." && pwd)
work=$top/build/peers
order=1
while getopts w:2 option; do
  case $option in
    w) work=$OPTARG ;;
    2) order=2 ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
[ $# -gt 0 ] || { echo "how many nodes? run.sh 20000 97000" >&2; exit 2; }
python=/usr/bin/python3   # Debian's, which has gmsh and dolfinx
program=${PROGRAM:-$top/driftwright}   # a built one, or the script that builds it first
about() {
  date -u "+%Y-%m-%d %H:%M UTC"
  echo "driftwright $("$program" --version), built $(date -u -r "${PROGRAM:-$top/build/release/app/driftwright}" "+%Y-%m-%d %H:%M UTC")"
  dpkg-query -W -f '${Package} ${Version}\n' freefem++ python3-dolfinx libpetsc-real3.18 calculix-ccx
  grep -m 1 "model name" /proc/cpuinfo
  echo "$(nproc) cores, load of other work: $(cut -d " " -f 1-3 /proc/loadavg)"
}
about
openblas=${OPENBLAS_FOLDER:-/usr/lib/x86_64-linux-gnu/openblas-serial}
peer() { env LD_LIBRARY_PATH="$openblas" OPENBLAS_NUM_THREADS=1 "$python" "$here/peer_$1.py" "$folder" --cap "$cap" "${@:2}"; }
# Peers that would take much longer than this are cut short; CalculiX is projected.
cap=${CAP_S:-600}
tolerances="--relative 2e-3 --absolute 7e-3"   # meets 0.05 K and 0.1 um with a margin

folders=()
for size in "$@"; do
  folder=$work/$size-order$order
  folders+=("$folder")
  [ -f "$folder/info.json" ] || "$python" "$here/make_mesh.py" "$size" "$folder" "$order"
  "$python" "$here/peer_driftwright.py" "$folder" "$program" --name reference --relative 1e-6 --absolute 1e-5
  for again in 1 2 3; do "$python" "$here/peer_driftwright.py" "$folder" "$program" --name driftwright_$again $tolerances; done
  "$python" "$here/peer_driftwright.py" "$folder" "$program" --name driftwright_heat $tolerances --heat-only
  "$python" "$here/peer_driftwright.py" "$folder" "$program" --name driftwright_one_thread $tolerances --threads 1
  # The first use of FEniCSx compiles its forms, which are kept for the next runs.
  peer fenicsx --name fenicsx_one_minute --solver multigrid --minutes 1
  if [ "$size" -le 150000 ]; then   # the elastic factor alone takes 16 GB at 390 000 nodes
    peer freefem --name freefem
    peer freefem --name freefem_influence --mechanics influence
    peer fenicsx --name fenicsx
    peer fenicsx --name fenicsx_influence --mechanics influence
  fi
  peer freefem --name freefem_heat --mechanics none
  peer fenicsx --name fenicsx_heat --mechanics none
  peer fenicsx --name fenicsx_multigrid --mechanics influence --solver multigrid
  peer fenicsx --name fenicsx_multigrid_2_ranks --mechanics influence --solver multigrid --ranks 2
  if [ "$size" -le 30000 ]; then   # an independent look at the reference: ones with another method, by other programs
    peer freefem --name freefem_fine_CN --mechanics influence --scheme CN --step 2
    peer fenicsx --name fenicsx_fine_CN --mechanics influence --scheme CN --step 2
    "$python" "$here/peer_calculix.py" "$folder" --name calculix_coupled --mode coupled --solver SPOOLES --cap 60
  fi
  if [ "$size" -le 150000 ]; then "$python" "$here/peer_calculix.py" "$folder" --name calculix_heat --cap 60; fi
done
"$python" "$here/table.py" reference "${folders[@]}"
about | tail -n 1
