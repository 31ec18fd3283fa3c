#!/bin/sh
# mix.sh: the kinds of instructions of a solve on a Cortex-M7 (planar MVC of two joints and of seven, to 1e-12 and to 1e-6), from
# QEMU's log of every block that is run, and an estimate of the cycles.
#
# QEMU knows no cycles. The estimate takes the latency of every kind from LLVM's scheduling model of the Cortex-M7 (Arm
# publishes none) as if nothing ever overlapped and no two instructions were ever issued together, and 6 cycles for every
# conditional branch as if each were mispredicted; all of memory answers at once (tightly coupled or in the caches).
set -eu
cd "$(dirname "$0")/../.."
cross=${CROSS:-target/cross}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
emulator=$(scripts/cross/private.sh qemu-system-arm qemu-system-arm)

# kinds JOINTS DECREASE: lines of a kind, how often, and its cycles.
kinds() {
    scripts/cross/run.sh cortex-m7 size -DCALLS=1 "-DJOINTS=$1" "-DDECREASE=$2"
    "$emulator" -M mps2-an500 -nographic -monitor none -serial none -semihosting-config enable=on,target=native \
        -d in_asm,exec,nochain -D "$folder/log" -kernel "$cross/cortex-m7/size" </dev/null
    awk "$count_kinds" "$folder/log"
}
count_kinds='
    /^IN:/ { block = ""; next }
    # "0x00000a5c:  ed97 0b00  vldr d0, [r7]"
    /^0x[0-9a-f]+: / {
        split($1, of, ":"); address = substr(of[1], 3)
        if (block == "") { block = address; blocks[block] = ""; listed[block] = 0 }
        word = ""
        for (i = 2; i <= NF; i++) if ($i !~ /^[0-9a-f][0-9a-f]([0-9a-f][0-9a-f])?$/) { word = $i; break }
        kind = kind_of(word)
        # Lists of registers take a cycle a word.
        if (match($0, /\{.*\}/)) {
            words = gsub(/,/, ",", $0) + 1
            if (word ~ /^v/) words *= 2
            kind = "list"; listed[block] += words
        }
        blocks[block] = blocks[block] kind ";"
        next
    }
    /^Trace / {
        # "Trace 0: 0x7f… [00000000/00000a5c/…] name"
        match($0, /\[[0-9a-f]+\/[0-9a-f]+\//)
        split(substr($0, RSTART + 1, RLENGTH - 2), of, "/")
        runs[of[2]]++
    }
    function kind_of(word) {
        if (word ~ /^v(div|sqrt)/) return "divide"
        if (word ~ /^v(mul|nmul)/) return "multiply"
        if (word ~ /^v(fma|fms|fnm)/) return "fused"
        if (word ~ /^v(mla|mls|nml)/) return "product and sum"
        if (word ~ /^v(add|sub|cmp|abs|neg|cvt|rint|maxnm|minnm|sel)/) return "add"
        if (word ~ /^v(ldr|str)/) return "memory"
        if (word ~ /^v/) return "move"
        if (word ~ /^(ldr|str|tbb|tbh)/) return "memory"
        if (word ~ /^(sdiv|udiv)/) return "integer division"
        if (word ~ /^(b(eq|ne|cs|hs|cc|lo|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)(\.[nw])?|cbz|cbnz)$/) return "conditional branch"
        if (word ~ /^(b|bl|bx|blx)(\.[nw])?$/) return "branch"
        if (word ~ /^(mul|mla|mls|smul|umul|smlal|umlal|umaal|smull|umull)/) return "integer product"
        return "integer"
    }
    END {
        name["add"] = "doubles: sums, comparisons"; name["multiply"] = "doubles: products"; name["divide"] = "doubles: quotients, roots"
        name["product and sum"] = "doubles: product and sum, each rounded"
        name["move"] = "doubles: moves"; name["memory"] = "loads and stores"; name["integer"] = "integers"
        name["integer product"] = "integers: products"; name["integer division"] = "integers: quotients"
        name["branch"] = "calls and jumps"; name["conditional branch"] = "conditional jumps"
        # Latencies; of memory that of a double.
        cycles["add"] = 4; cycles["multiply"] = 7; cycles["product and sum"] = 11; cycles["divide"] = 30; cycles["move"] = 3
        cycles["memory"] = 2; cycles["integer division"] = 7; cycles["integer product"] = 2; cycles["integer"] = 1
        cycles["branch"] = 2; cycles["conditional branch"] = 6
        for (block in runs) {
            if (!(block in blocks)) { missing += runs[block]; continue }
            n = split(blocks[block], kinds, ";")
            for (i = 1; i < n; i++) count[kinds[i]] += runs[block]
            words_listed += listed[block] * runs[block]
        }
        if (missing > 0) { print "mix.sh: blocks without instructions: " missing >"/dev/stderr"; exit 1 }
        cycles["list"] = 1 + words_listed / count["list"]; name["list"] = "loads and stores of several registers"
        order = "add;multiply;product and sum;divide;move;memory;list;integer;integer product;integer division;branch;conditional branch"
        if (count["fused"] > 0) { print "mix.sh: fused multiply-adds" >"/dev/stderr"; exit 1 }
        n = split(order, kinds, ";")
        for (i = 1; i <= n; i++) printf "%s;%.0f;%.3g\n", name[kinds[i]], count[kinds[i]], cycles[kinds[i]]
    }'

kinds 2 1e-12 >"$folder/1"
kinds 2 1e-6 >"$folder/2"
kinds 7 1e-12 >"$folder/3"
kinds 7 1e-6 >"$folder/4"
cat "$folder"/[1-4] | awk -F ';' '
    {
        run = int((NR - 1) / 12) + 1
        if (run == 1) order[NR] = $1
        count[$1, run] = $2; each[$1, run] = $3
        total[run] += $2; cycles[run] += $2 * $3
    }
    END {
        if (NR != 48) { print "mix.sh: " NR " lines" >"/dev/stderr"; exit 1 }
        print "| of a hundred instructions | 2 joints | to 1e-6 | 7 joints | to 1e-6 | cycles each, at most |"
        print "| --- | --- | --- | --- | --- | --- |"
        for (i = 1; i <= 12; i++) {
            printf "| %s |", order[i]
            for (run = 1; run <= 4; run++) printf " %.1f |", 100 * count[order[i], run] / total[run]
            printf " %s |\n", each[order[i], 1]
        }
        printf "| instructions |"
        for (run = 1; run <= 4; run++) printf " %.0f |", total[run]
        printf " |\n| cycles, at most |"
        for (run = 1; run <= 4; run++) printf " %.0f |", cycles[run]
        printf " |\n| cycles an instruction |"
        for (run = 1; run <= 4; run++) printf " %.2f |", cycles[run] / total[run]
        print " |"
    }'
