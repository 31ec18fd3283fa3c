#!/bin/sh
# rs274.sh FILE.ngc …: runs NC programs through LinuxCNC's interpreter, which must accept every line.
set -eu
for program in "$@"; do
    calls=$(rs274 -g "$program") || { echo "$program: refused by rs274" >&2; exit 1; }
    feeds=$(printf '%s\n' "$calls" | grep -c -E 'ARC_FEED|STRAIGHT_FEED') || true
    words=$(grep -c -E '^G[123] ' "$program") || true
    if [ "$feeds" != "$words" ]; then
        echo "$program: $words cutting moves written, $feeds understood" >&2
        exit 1
    fi
    echo "$program: rs274 cuts all $feeds moves"
done
