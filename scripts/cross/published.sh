#!/bin/sh
# published.sh: no function takes more stack on a Cortex-M4 than docs/bounds.md says. Another compiler may lay out a frame
# otherwise: a tenth more is allowed, and 64 bytes.
set -eu
cd "$(dirname "$0")/../.."
scripts/cross/run.sh cortex-m4 stack
awk -F ' *[|;] *' '
    FNR == NR { if ($2 ~ /^minvar_/ && NF > 6) { said[$2] = $5; functions++ } next }
    {
        found++
        if (!($1 in said)) { print "docs/bounds.md does not know " $1 " (make bounds)"; bad = 1 }
        else if ($2 > 1.1 * said[$1] + 64) { print $1 " takes " $2 " bytes of stack, docs/bounds.md says " said[$1]; bad = 1 }
    }
    END {
        if (found < 20 || functions < 20) { print "only " found " functions, docs/bounds.md has " functions; bad = 1 }
        if (!bad) print "cortex-m4: none of the " found " functions takes more stack than docs/bounds.md says"
        exit bad
    }' docs/bounds.md "${CROSS:-target/cross}/cortex-m4/stack.txt"
