#!/bin/sh
# Writes the tables of what files may hold into docs/reference/ anew.
#
#     schema_tables.sh PROGRAM FOLDER_OF_THE_PROJECT
set -eu
write() {  # PROGRAM FOLDER PAGE COMMAND...
  file="$2/docs/reference/$3.md"
  program=$1
  shift 3
  "$program" "$@" --markdown >"$file.tables"
  awk -v tables="$file.tables" -v begin="<!-- driftwright $* --markdown -->" '
    $0 == begin { print; while ((getline line < tables) > 0) print line; skips = 1 }
    $0 == "<!-- end -->" { skips = 0 }
    !skips { print }' "$file" >"$file.new"
  mv "$file.new" "$file"
  rm "$file.tables"
}
for page in scenario sweep diagnosis; do write "$1" "$2" "$page" schema "$page"; done
write "$1" "$2" scenario list ranges
