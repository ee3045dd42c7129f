#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Times of the window as ratios to the program of before, in one go: the two take turns, medians are compared.
#   git worktree add ../before COMMIT && git -C ../before checkout THIS_BRANCH -- tests/bench
#   cmake -S ../before -B ../before/build ... && ninja -C ../before/build studio_times
#   tests/bench/studio_times.sh ../before/build/tests/studio_times build/release/tests/studio_times P.beam [ROUNDS]
# P.beam has solved frames. Needs a display, or xvfb-run.
set -euo pipefail
before=${1:?studio_times of before} now=${2:?studio_times of now} project=${3:?a project with solved frames} rounds=${4:-7}
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
export HOME=$home XDG_CONFIG_HOME=$home XDG_CACHE_HOME=$home XDG_DATA_HOME=$home

for ((round = 1; round <= rounds; ++round)); do
  # Who comes first changes: the second finds the files in memory.
  order=(before now)
  ((round % 2)) || order=(now before)
  for which in "${order[@]}"; do
    BEAM_STARTED_NS=$(date +%s%N) "${!which}" "$project" >>"$home/$which.txt" 2>>"$home/said.txt" ||
      { cat "$home/said.txt" >&2; exit 1; }
  done
done

median() { awk -F'\t' -v w="$2" '$1 == w { print $2 }' "$1" | sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }
printf '%-26s %12s %12s %8s\n' "median of $rounds" "before, ms" "now, ms" ratio
for what in "start to window" "project to first picture" "frame change" "channel change"; do
  b=$(median "$home/before.txt" "$what") n=$(median "$home/now.txt" "$what")
  awk -v w="$what" -v b="$b" -v n="$n" 'BEGIN { printf "%-26s %12.1f %12.1f %8.2f\n", w, b, n, n / b }'
done
