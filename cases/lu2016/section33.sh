#!/usr/bin/env bash
# Lu & Wang (2016), section 3.3: the spalling test (figures 10 to 12, table 2), by five methods and on finer bars too.
# Three minutes.
#
#   cases/lu2016/section33.sh [RESULTS]      (default: results/lu2016)
set -euo pipefail
python3 -c 'import dembound' # ends here, before anything is run, where this is not the Python of dembound
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/lu2016}
mkdir -p "$results"

echo "== Figures 10 to 12, table 2: five methods, spacings and steps of the paper, a quarter and a tenth of them"
runs=()
test_bar() { # SPACING TIME_STEP NAME METHOD
    local name=rod_$3_$1
    dembound run "$cases/rod_test.toml" --set "bar.spacing=$1" --set "run.time_step=$2" --set "method={$4}" \
        --name "$name" --output "$results"
    runs+=("$results/$name")
}
test_bars() { # SPACING TIME_STEP
    test_bar "$1" "$2" pd3 'type="peridynamics",horizon=3'
    test_bar "$1" "$2" pd1_pd3 'type="switch",horizon=3,before="peridynamics"'
    test_bar "$1" "$2" fdm_pd3 'type="switch",horizon=3'
    test_bar "$1" "$2" patch 'type="patch",horizon=3'
    test_bar "$1" "$2" fdm 'type="finite_difference"'
}
test_bars 0.01 2e-6
test_bars 0.0025 0.5e-6
test_bars 0.001 0.2e-6
dembound paper lu2016 --figure 10 --figure 11 --figure 12 --output "$results"
python3 "$cases/spall_costs.py" "${runs[@]}" | tee "$results/table2.md"

echo "== The same under 36 pulses"
python3 "$cases/many_pulses.py" "${runs[@]}" | tee "$results/many_pulses.md"

echo "== What the methods cost on 4000 nodes"
runs=()
test_bars 0.00025 0.05e-6
python3 "$cases/spall_costs.py" --repeats 11 "${runs[@]}" | tee "$results/table2_fine.md"
