#!/bin/sh
# whole.sh LIBRARY PROGRAM [FLAG...]: links a static library for Arm whole, every function of the C interface and what it
# needs; whatever is missing is an error. FLAGs are the linker's.
set -eu
library=$1 program=$2
shift 2
functions=$(nm --defined-only "$library" 2>/dev/null | awk '$2 == "T" && $3 ~ /^minvar_/ { print "-u", $3 }' | sort -u)
# shellcheck disable=SC2086
exec ld.lld -m armelf --gc-sections -e minvar_version "$@" $functions "$library" -o "$program"
