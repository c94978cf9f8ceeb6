#!/usr/bin/env bash
# Zhou et al. (2018), sections 2.2 and 2.3: runs and calibrations of the long bar, and pictures for figures 2, 3 and
# 6 to 13. Takes about a quarter of an hour on two cores.
#
#   cases/zhou2018/run.sh [RESULTS]      (default: results/zhou2018)
set -euo pipefail
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/zhou2018}
figures=$results/figures
mkdir -p "$figures"
a=$cases/long_bar_a.toml b=$cases/long_bar_b.toml b2=$cases/long_bar_b_lambda2.toml c=$cases/long_bar_c.toml

echo "== Figures 2, 9, 10: the patterns, their right sides, a brick with its seams"
dembound packing "$a" "$b" "$b2" "$c" --side right --output "$figures/fig02_10_patterns.png"
small=(--set 'packing.brick=[10.0, 10.0]' --set 'packing.size=[10.0, 10.0]' --set 'monitor=[]')  # so that single disks can be seen
dembound packing "$b" --brick "${small[@]}" --output "$figures/fig09_brick_b.png"
dembound packing "$c" --brick "${small[@]}" --output "$figures/fig09_brick_c.png"

echo "== Figures 3, 11, 12: beta = 1"
dembound run "$a" "$b" "$b2" "$c" --output "$results"
dembound plot "$results"/long_bar_{a,b} --output "$figures/fig03_histories.png"
dembound plot "$results"/long_bar_{a,b,b_lambda2,c} --boundary right --output "$figures/fig11_12_boundary.png"

echo "== Figure 6: ratio iteration on pattern B from 0.5 and 2.0"
for start in 0.5 2.0; do
    dembound calibrate "$b" --boundary right --method ratio --start $start --name from_$start --output "$results" \
        --calibrated "$results/from_$start.toml"
done
dembound plot "$results"/from_{0.5,2.0}_calibration_right_p_ratio --output "$figures/fig06_iteration.png"

echo "== Figures 7, 8: P4 in the passes of that iteration"
beta_of_pass() { # START PASS, a number or last
    python3 -c "import json, sys
passes = json.load(open(sys.argv[1]))['beta']
print(passes[-1 if sys.argv[2] == 'last' else int(sys.argv[2]) - 1])" \
        "$results/from_${1}_calibration_right_p_ratio/summary.json" "$2"
}
for start in 0.5 2.0; do
    runs=()
    for pass in 1 2 3 5 last; do
        name=start_${start}_pass_$pass
        dembound run "$b" --set boundary.right.beta_p="$(beta_of_pass $start $pass)" --set output.snapshots=1 \
            --name "$name" --output "$results"
        runs+=("$results/$name")
    done
    dembound plot "${runs[@]}" --monitor P4 --output "$figures/fig07_08_p4_from_$start.png"
done

echo "== Figure 13: ratio iteration from 1.0 on all patterns, and the two quicker ways"
records=()
for case in "$a" "$b" "$b2" "$c"; do
    name=$(basename "$case" .toml)
    for method in "ratio --start 1.0" impedance homogenised; do
        dembound calibrate "$case" --boundary right --method $method --output "$results" \
            --calibrated "$results/${name}_calibrated_${method%% *}.toml"
    done
    records+=("$results/${name}_calibration_right_p_ratio")
done
dembound plot "${records[@]}" --output "$figures/fig13_patterns.png"
echo "figures are in $figures"
