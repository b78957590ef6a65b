#!/bin/bash
# Every notebook runs from its first cell to its last: notebooks_test.sh FOLDER_OF_THE_PROJECT (with PYTHONPATH at the package).
set -eu
top=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/python"
cp -r "$top/python/notebooks" "$work/python/notebooks"
ln -s "$top/scenarios" "$work/scenarios"
cd "$work/python/notebooks"
export HOME="$work"   # Jupyter writes settings there
for notebook in *.ipynb; do
  /usr/bin/python3 -m nbconvert --to html --execute "$notebook" --ExecutePreprocessor.timeout=600 --output "$work/$notebook.html" 2>"$work/log" ||
    { tail -n 30 "$work/log"; echo "$notebook failed"; exit 1; }
  grep -q '<img' "$work/$notebook.html" || { echo "$notebook shows no picture"; exit 1; }
done
echo "notebooks: all pass"
