#!/bin/bash
# Follows a page to the letter: writes the files that it shows (after a line <!-- file NAME -->) and
# runs its sh blocks in one shell, in their order. tutorial.sh VIGIA PAGE CONFIG FOLDER
set -euo pipefail
vigia=$1
page=$2
config=$3
folder=$4

rm -rf "$folder"
mkdir -p "$folder/bin"
ln -s "$vigia" "$folder/bin/vigia"
ln -s "$config" "$folder/config"

# Files go into the folder in which the shell is by then.
awk '
  /^<!-- file .* -->$/ { file = $3; next }
  /^```(sh|yaml)$/ && !inside {
    inside = 1
    shell = /sh$/
    if (!shell && file == "") { print "a block without a file: " FNR > "/dev/stderr"; exit 1 }
    if (!shell) printf "cat >%s <<\"END_OF_FILE\"\n", file
    next
  }
  /^```$/ && inside { if (!shell) print "END_OF_FILE"; inside = 0; file = ""; next }
  inside { print }' "$page" >"$folder/page.sh"
[ -s "$folder/page.sh" ] || { echo "$page has no blocks to run" >&2; exit 1; }

cd "$folder"
PATH=$folder/bin:$PATH bash -euxo pipefail page.sh
