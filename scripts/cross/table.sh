#!/bin/sh
# table.sh [--short] TARGET...: compares what the targets printed with tests/cross/hashes.txt, every line of it (--short:
# without those of `make cross` alone). Exit status 1 if anything differs or is missing.
set -eu
cd "$(dirname "$0")/../.."
cross=${CROSS:-target/cross}
expected=$cross/expected.txt
mkdir -p "$cross"
if [ "${1:-}" = --short ]; then
    shift
    grep -v '^long/' tests/cross/hashes.txt >"$expected"
else
    cp tests/cross/hashes.txt "$expected"
fi
summary() { sha256sum "$1" | cut -c 1-16; }
bad=0
printf '| target | all lines | lines | differ |\n| --- | --- | --- | --- |\n'
printf '| committed | %s | %d | |\n' "$(summary "$expected")" "$(wc -l <"$expected")"
for target in "$@"; do
    found=$cross/$target/corpus.txt
    if [ ! -e "$found" ]; then
        printf '| %s | did not run to its end | | |\n' "$target"
        bad=1
        continue
    fi
    diff "$expected" "$found" | awk '/^[<>]/ && !seen[$2]++ { print $2 }' >"$cross/$target/differing.txt"
    printf '| %s | %s | %d | %d |\n' "$target" "$(summary "$found")" "$(wc -l <"$found")" "$(wc -l <"$cross/$target/differing.txt")"
    cmp -s "$expected" "$found" || bad=1
done
for target in "$@"; do
    list=$cross/$target/differing.txt
    if [ -s "$list" ]; then
        printf '\n%s differs in\n' "$target"
        head -40 "$list" | sed 's/^/    /'
        [ "$(wc -l <"$list")" -le 40 ] || printf '    … all of them: %s\n' "$list"
    fi
done
exit $bad
