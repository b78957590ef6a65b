#!/usr/bin/env bash
# bench/peers/run.sh [-w FOLDER] [-2] SIZE...: the same 300 minutes on the same meshes, by Driftwright, FreeFEM and CalculiX.
#
#   bench/peers/run.sh 20000 97000          meshes of about so many nodes of linear tetrahedra; -2: of quadratic ones
#
# Needs freefem++, calculix-ccx, libopenblas0-pthread, python3-gmsh, python3-numpy and time (Debian 12), which are no packages of
# Driftwright. FreeFEM gets OpenBLAS, without which it takes twice as long. One run at a time: keep the machine quiet.
# Writes a table a mesh, and table.csv with the logs beside the mesh.
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
python=/usr/bin/python3   # Debian's, which has gmsh
program=${PROGRAM:-$top/driftwright}   # a built one, or the script that builds it first
"$program" --version
openblas=${OPENBLAS_FOLDER:-/usr/lib/x86_64-linux-gnu/openblas-pthread}
freefem() { env LD_LIBRARY_PATH="$openblas" OPENBLAS_NUM_THREADS=1 "$python" "$here/peer_freefem.py" "$@"; }
# Peers that would take much longer than this are cut short; CalculiX is projected.
cap=${CAP_S:-600}
tolerances="--relative 2e-3 --absolute 7e-3"   # meets 0.05 K and 0.1 um with a margin

for size in "$@"; do
  folder=$work/$size-order$order
  [ -f "$folder/info.json" ] || "$python" "$here/make_mesh.py" "$size" "$folder" "$order"
  "$python" "$here/peer_driftwright.py" "$folder" "$program" --name reference --relative 1e-6 --absolute 1e-5
  for again in 1 2 3; do "$python" "$here/peer_driftwright.py" "$folder" "$program" --name driftwright_$again $tolerances; done
  "$python" "$here/peer_driftwright.py" "$folder" "$program" --name driftwright_heat $tolerances --heat-only
  if [ "$size" -le 150000 ]; then   # the elastic factor alone takes 16 GB at 390 000 nodes
    freefem "$folder" --name freefem --cap "$cap"
    freefem "$folder" --name freefem_influence --mechanics influence --cap "$cap"
  fi
  freefem "$folder" --name freefem_heat --mechanics none --cap "$cap"
  if [ "$size" -le 30000 ]; then   # an independent look at the reference: one with another method, by another program
    freefem "$folder" --name freefem_fine_CN --mechanics influence --scheme CN --step 2 --cap "$cap"
    "$python" "$here/peer_calculix.py" "$folder" --name calculix_coupled --mode coupled --solver SPOOLES --cap 60
  fi
  if [ "$size" -le 150000 ]; then "$python" "$here/peer_calculix.py" "$folder" --name calculix_heat --cap 60; fi
  "$python" "$here/table.py" reference "$folder"
done
