#!/bin/sh
# bounds.sh [--x86-64]: tables of stack, workspace, code and instructions on x86-64 (callgrind counts), Cortex-M7 and Cortex-M4
# (QEMU counts). With --x86-64 of this machine alone.
set -eu
cd "$(dirname "$0")/../.."
export CROSS="${CROSS:-target/cross}"
if [ "${1:-}" = --x86-64 ]; then targets=x86-64; else targets="x86-64 cortex-m7 cortex-m4"; fi
# A nanosecond of the emulated clock an instruction.
export ICOUNT="-icount shift=0,sleep=off"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

for target in $targets; do
    if [ "$target" = x86-64 ]; then
        UNDER="valgrind -q --tool=callgrind --callgrind-out-file=$folder/count" scripts/cross/run.sh x86-64 solves -DCALLGRIND
        # The n-th file belongs to the n-th line.
        awk -F ';' -v OFS=';' -v folder="$folder" '{
            file = folder "/count." NR
            while ((getline line < file) > 0) if (line ~ /^totals:/) { split(line, of, " "); $9 = of[2] }
            print
        }' "$CROSS/x86-64/solves.txt" >"$folder/x86-64.solves"
    else
        scripts/cross/run.sh "$target" solves
        cp "$CROSS/$target/solves.txt" "$folder/$target.solves"
    fi
    # Software's double arithmetic changes neither stack nor linearisations, and takes long.
    if [ "$target" != cortex-m4 ]; then scripts/cross/run.sh "$target" worst -DWITH_LONG=1; fi
    for calls in 0 1 2 3; do
        scripts/cross/run.sh "$target" size -DCALLS=$calls
        size "$CROSS/$target/size" | awk 'NR == 2 { print $1 + $2 }'
    done >"$folder/$target.sizes"
done

printf '\nWhole solves, each from the data to a relative decrease of 1e-12 unless it says otherwise.\n\n'
for target in $targets; do sed "s/^/$target;/" "$folder/$target.solves"; done | awk -F ';' -v targets="$targets" '
    BEGIN { n = split(targets, target, " ") }
    $2 == "calibration" { calibration = calibration sprintf("%s: %d counted of 2000002. ", $1, $10); next }
    {
        key = $2 ";" $3
        if (!(key in fixed)) order[++count] = key
        fixed[key] = sprintf("| %s | %s | %d | %d | %d | %d | %d |", $2, $3, $4, $5, $6, $8, $9)
        stack[key, $1] = $7; instructions[key, $1] = $10
        # The same solve everywhere.
        if (key in same && same[key] != $4 ";" $5 ";" $8 ";" $9) bad = bad key " "
        same[key] = $4 ";" $5 ";" $8 ";" $9
    }
    END {
        printf "| curve | functional | elements | unknowns | workspace, bytes | iterations | linearisations |"
        for (t = 1; t <= n; t++) printf " stack, bytes, %s |", target[t]
        for (t = 1; t <= n; t++) printf " instructions, %s |", target[t]
        printf "\n|"
        for (i = 0; i < 7 + 2 * n; i++) printf " --- |"
        print ""
        for (i = 1; i <= count; i++) {
            printf "%s", fixed[order[i]]
            for (t = 1; t <= n; t++) printf " %d |", stack[order[i], target[t]]
            for (t = 1; t <= n; t++) printf " %d |", instructions[order[i], target[t]]
            print ""
        }
        if (calibration != "") print "\nThe meter on a loop: " calibration
        if (bad != "") { print "\nnot the same everywhere: " bad; exit 1 }
    }'

printf '\nThe deepest stack of every function over the corpus of tests/cross, bytes; 256 is as much as that or less.\n\n'
for target in $targets; do
    [ "$target" = cortex-m4 ] || sed -n "s/^stack;/$target;/p" "$CROSS/$target/worst.txt"
done | awk -F ';' -v targets="${targets% cortex-m4}" '
    BEGIN { n = split(targets, target, " ") }
    { if (!($2 in calls)) order[++count] = $2; calls[$2] = $3; stack[$2, $1] = $4; where[$2] = $6 }
    END {
        printf "| function | calls |"
        for (t = 1; t <= n; t++) printf " %s |", target[t]
        printf " deepest in |\n| --- | --- |"
        for (t = 0; t <= n; t++) printf " --- |"
        print ""
        for (i = 1; i <= count; i++) {
            printf "| %s | %d |", order[i], calls[order[i]]
            for (t = 1; t <= n; t++) printf " %d |", stack[order[i], target[t]]
            printf " %s |\n", where[order[i]]
        }
    }'

printf '\nCode and constants of the library in a program that calls no more than this, bytes.\n\n'
for target in $targets; do sed "s/^/$target /" "$folder/$target.sizes"; done | awk -v targets="$targets" '
    BEGIN { n = split(targets, target, " "); split("solving;and measuring;and G-code", what, ";") }
    { size[$1, row[$1]++] = $2 }
    END {
        printf "| program |"
        for (t = 1; t <= n; t++) printf " %s |", target[t]
        printf "\n| --- |"
        for (t = 1; t <= n; t++) printf " --- |"
        print ""
        for (i = 1; i <= 3; i++) {
            printf "| %s |", what[i]
            for (t = 1; t <= n; t++) printf " %d |", size[target[t], i] - size[target[t], 0]
            print ""
        }
    }'
