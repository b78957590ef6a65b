#!/bin/sh
# Writes the tables of what files may hold into docs/ anew.
#
#     schema_tables.sh PROGRAM FOLDER_OF_THE_PROJECT
set -eu
for page in scenario sweep diagnosis; do
  file="$2/docs/$page.md"
  "$1" schema "$page" --markdown >"$file.tables"
  awk -v tables="$file.tables" -v begin="<!-- driftwright schema $page --markdown -->" '
    $0 == begin { print; while ((getline line < tables) > 0) print line; skips = 1 }
    $0 == "<!-- end -->" { skips = 0 }
    !skips { print }' "$file" >"$file.new"
  mv "$file.new" "$file"
  rm "$file.tables"
done
