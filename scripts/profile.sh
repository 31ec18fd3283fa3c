#!/bin/sh
# profile.sh PROGRAM DECREASE: counts the instructions of every set of Appendix A and says where they go (valgrind's callgrind).
set -eu
program=$1 decrease=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# What each function of the kernel is called in the table: the first pattern that fits.
"$program" | while read -r set functional; do
    line=$(valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect='*profiled*' \
        "$program" "$set" "$functional" "$decrease" 1 2>/dev/null)
    callgrind_annotate --auto=no --threshold=100 "$folder/out" 2>/dev/null | awk -v set="$set $functional" -v line="$line" '
        # "1,234 (5.67%)  file:function [object]": the same function may stand under several files.
        /^ *[0-9,]+ \( *[0-9.]+%\)/ {
            count = $1; gsub(",", "", count)
            if ($0 ~ /PROGRAM TOTALS/) next
            what = "rest"
            if ($0 ~ /rows::Integrand.*::derivatives|fairness/) what = "hessians"
            else if ($0 ~ /by_unknowns|linearise|second_map|local_coordinates/) what = "unknowns"
            else if ($0 ~ /sums_of_rows|rows::Integrand.*::value/) what = "values"
            else if ($0 ~ /natural::fit/) what = "fit"
            else if ($0 ~ /natural/) what = "arc length"
            else if ($0 ~ /envelope|trust_region|rank_two|ordering/) what = "algebra"
            else if ($0 ~ /figures_of|measure|report/) what = "figures"
            else if ($0 ~ /start::/) what = "start"
            sum[what] += count; all += count
        }
        END {
            split(line, of, " ")
            printf "| %s | %d | %d | %.1f | %.1f |", set, of[1], of[2], of[3] / of[1], all / of[1] / 1000
            n = split("start,arc length,fit,hessians,unknowns,values,algebra,figures,rest", names, ",")
            for (i = 1; i <= n; i++) printf " %.0f |", 100 * sum[names[i]] / all
            print ""
        }'
done
