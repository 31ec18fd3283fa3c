#!/bin/sh
# bounds.sh: tables of stack, workspace, code and instructions on x86-64 (callgrind counts), Cortex-M7 and Cortex-M4 (QEMU
# counts), as docs/bounds.md has them.
set -eu
cd "$(dirname "$0")/../.."
export CROSS="${CROSS:-target/cross}"
targets="x86-64 cortex-m7 cortex-m4"
# A nanosecond of the emulated clock an instruction.
export ICOUNT="-icount shift=0,sleep=off"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# counted PROGRAM FIELD [FLAG...]: runs it under callgrind, which writes a file for every reading; what the program printed in
# that field is the file's number.
counted() {
    program=$1 field=$2
    shift 2
    UNDER="valgrind -q --tool=callgrind --callgrind-out-file=$folder/$program" \
        scripts/cross/run.sh x86-64 "$program" -DCALLGRIND "$@"
    awk -F ';' -v OFS=';' -v files="$folder/$program." -v field="$field" '$1 == "stack" { print; next } {
        file = files $field
        while ((getline line < file) > 0) if (line ~ /^totals:/) { split(line, of, " "); $field = of[2] }
        close(file)
        print
    }' "$CROSS/x86-64/$program.txt" >"$folder/x86-64.$program"
}

for target in $targets; do
    if [ "$target" = x86-64 ]; then
        counted solves 9
        counted worst 8 -DWITH_LONG=1
    else
        scripts/cross/run.sh "$target" solves
        cp "$CROSS/$target/solves.txt" "$folder/$target.solves"
        scripts/cross/run.sh "$target" stack
    fi
    # Arithmetic in software takes long, and changes no number of iterations.
    if [ "$target" = cortex-m7 ]; then
        scripts/cross/run.sh "$target" worst -DWITH_LONG=1
        cp "$CROSS/$target/worst.txt" "$folder/$target.worst"
    fi
    for calls in 0 1 2 3; do
        scripts/cross/run.sh "$target" size -DCALLS=$calls
        size "$CROSS/$target/size" | awk 'NR == 2 { print $1 + $2 }'
    done >"$folder/$target.sizes"
done

cat <<'END'
# What a solve takes

Written by `make bounds`, for whoever has to find a place and a time for it in a controller. Stack is painted and looked at
afterwards. Instructions are counted: on x86-64 by callgrind, on a Cortex-M7 (double precision in hardware) and a Cortex-M4 (single
precision: doubles are software) by QEMU, in steps of 40. The workspace is the caller's, of the size that
`minvar_curve_workspace_len()` says.

An iteration moves every element, so that instructions ≤ elements × iterations × the most that an element and iteration take, which is
below for every functional; `max_iterations` is yours to set, and a solve that ends there leaves the best curve so far.
END

printf '\n## Whole solves\n\nEach from the data to a relative decrease of 1e-12 unless it says otherwise.\n\n'
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
            for (t = 1; t <= n; t++) printf " %.0f |", instructions[order[i], target[t]]
            print ""
        }
        if (calibration != "") print "\nThe meter on a loop: " calibration
        if (bad != "") { print "\nnot the same everywhere: " bad; exit 1 }
    }'

printf '\n## Instructions an element and iteration\n\n'
printf 'Over every solve and update of the corpus in tests/cross. The most is where an iteration tries other\n'
printf 'minima of single elements, or where so few iterations are left that the start is most of the work; a linearisation is that of one\n'
printf 'element, with all else that the solve does shared out among them.\n\n'
for target in x86-64 cortex-m7; do sed -n "s/^solve;/$target;/p" "$folder/$target.worst"; done | sort -t ';' -k 1,1r -k 3,4 | awk -F ';' '
    # Of solves that the data alone decide, nothing is left to iterate.
    function rounds() { return $6 > 0 ? $6 : 1 }
    {
        key = $3 ", " $4
        if (!(key in cases)) order[++count] = key
        if ($1 == "x86-64") cases[key]++
        each = $8 / ($5 * rounds())
        if (each > most[key, $1]) { most[key, $1] = each; where[key, $1] = $9 }
        if ($7 > 0 && $8 / $7 > linear[key, $1]) linear[key, $1] = $8 / $7
        sum[key, $1] += $8; work[key, $1] += $7; parts[key, $1] += $5 * rounds()
    }
    END {
        split("x86-64;cortex-m7", target, ";")
        printf "| functional | solves |"
        for (t = 1; t <= 2; t++) printf " %s: mean | most | a linearisation: mean | most |", target[t]
        print " the most of Cortex-M7 in |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
        for (i = 1; i <= count; i++) {
            key = order[i]
            printf "| %s | %d |", key, cases[key]
            for (t = 1; t <= 2; t++) {
                of = key SUBSEP target[t]
                printf " %.0f | %.0f | %.0f | %.0f |", sum[of] / parts[of], most[of], sum[of] / work[of], linear[of]
            }
            printf " %s |\n", where[key, "cortex-m7"]
        }
    }'

printf '\n## Stack of every function\n\nBytes. Bound: the deepest chain of calls in the machine code, whatever the data; seen: the\n'
printf 'deepest over the corpus, 256 for that or less. What a callback of yours takes comes on top.\n\n'
for target in cortex-m7 cortex-m4; do sed "s/^/bound;$target;/" "$CROSS/$target/stack.txt"; done >"$folder/stacks"
for target in x86-64 cortex-m7; do sed -n "s/^stack;/seen;$target;/p" "$folder/$target.worst"; done >>"$folder/stacks"
awk -F ';' '
    { if (!($3 in known)) { known[$3]; order[++count] = $3 } }
    $1 == "bound" { bound[$3, $2] = $4 }
    $1 == "seen" { calls[$3] = $4; seen[$3, $2] = $5 }
    END {
        print "| function | Cortex-M7, bound | seen | Cortex-M4, bound | x86-64, seen | calls |\n| --- | --- | --- | --- | --- | --- |"
        for (i = 1; i <= count; i++) {
            f = order[i]
            printf "| %s | %d | %s | %d | %s | %s |\n", f, bound[f, "cortex-m7"], seen[f, "cortex-m7"],
                bound[f, "cortex-m4"], seen[f, "x86-64"], calls[f]
            if (seen[f, "cortex-m7"] > 256 && seen[f, "cortex-m7"] > bound[f, "cortex-m7"]) bad = bad f " "
        }
        if (bad != "") { print "\nmore was seen than the bound allows: " bad; exit 1 }
    }' "$folder/stacks"

printf '\n## Code\n\nCode and constants of the library in a program that calls no more than this, bytes.\n\n'
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

printf '\n## Cycles of a Cortex-M7\n\nQEMU counts no cycles. The instructions of a solve (planar MVC: the coving of the thesis, and seven points) by kind, each\n'
printf 'with its latency in the scheduling model that LLVM has of this processor, as if no two ever overlapped, every conditional jump\n'
printf 'were mispredicted and all memory answered at once (tightly coupled, or in the caches): an estimate from above.\n\n'
scripts/cross/mix.sh
