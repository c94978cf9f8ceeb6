#!/usr/bin/env bash
# Zhou et al. (2018), sections 2.2 and 2.3: figures 2, 3 and 6 to 13, and the two quicker ways to calibrate. Takes some
# ten minutes on two cores.
#
#   cases/zhou2018/run.sh [RESULTS]      (default: results/zhou2018)
set -euo pipefail
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/zhou2018}
mkdir -p "$results"

echo "== Figures 2, 3 and 6 to 13"
figures=()
for number in 2 3 6 7 8 9 10 11 12 13; do figures+=(--figure $number); done
dembound paper zhou2018 "${figures[@]}" --output "$results"

echo "== The ratio iteration, and the two quicker ways"
for case in long_bar_a long_bar_b long_bar_b_lambda2 long_bar_c; do
    for method in "ratio --start 1.0" impedance homogenised; do
        dembound calibrate "$cases/$case.toml" --boundary right --method $method --output "$results" \
            --calibrated "$results/${case}_calibrated_${method%% *}.toml"
    done
done
echo "figures are in $results"
