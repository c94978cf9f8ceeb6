#!/usr/bin/env bash
# Beyond the paper's figures: S waves, the input side, the extremes of beta, and the whole bar instead of a strip.
# Takes about ten minutes on two cores.
#
#   cases/zhou2018/more.sh [RESULTS]      (default: results/zhou2018)
set -euo pipefail
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/zhou2018}
mkdir -p "$results"

result() { # FOLDER: the calibrated factor it holds
    python3 -c "import json, sys; print(json.load(open(sys.argv[1]))['result'])" "$results/$1/summary.json"
}
calibrate_and_run() { # CASE SIDE p|s: calibrate with few runs or none, then run calibrated
    for method in homogenised impedance; do
        dembound calibrate "$cases/$1.toml" --boundary "$2" --wave "$3" --method $method --output "$results" \
            --calibrated "$results/$1_calibrated_$method.toml"
    done
    dembound run "$cases/$1.toml" --name "$1_calibrated" --output "$results" --set output.snapshots=1 \
        --set "boundary.$2.beta_$3=$(result "$1_calibration_$2_$3_impedance")"
}

echo "== Calibrated ends under P waves, and the input side"
for case in long_bar_b long_bar_b_lambda2 long_bar_c; do calibrate_and_run $case right p; done
calibrate_and_run long_bar_b_input left p

echo "== S waves"
for case in long_bar_a_shear long_bar_b_shear long_bar_c_shear; do
    dembound run "$cases/$case.toml" --set output.snapshots=1 --output "$results"
    calibrate_and_run $case right s
done

echo "== No dashpots, and far too strong ones"
for beta in 0 1e4; do
    dembound run "$cases/long_bar_b.toml" --name "beta_$beta" --set boundary.right.beta_p=$beta \
        --set output.snapshots=1 --output "$results"
done

echo "== The whole bar instead of a strip"
dembound calibrate "$cases/long_bar_b.toml" --boundary right --full --name whole --output "$results" \
    --calibrated "$results/whole.toml"
