#!/usr/bin/env bash
# Lu & Wang (2016), section 3.2: a pulse that runs to and fro (figures 6 and 7), and how wrong it is at each passage.
# Half a minute.
#
#   cases/lu2016/section32.sh [RESULTS]      (default: results/lu2016)
set -euo pipefail
python3 -c 'import dembound' # ends here, before anything is run, where this is not the Python of dembound
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/lu2016}
mkdir -p "$results/figures"

echo "== Figures 6, 7a: finite differences and four horizons"
passage() { # NAME SETTING...
    local settings=()
    for setting in "${@:2}"; do settings+=(--set "$setting"); done
    dembound run "$cases/fig7.toml" "${settings[@]}" --name "fig7_$1" --output "$results"
}
peridynamics() { # HORIZON
    echo "method={type=\"peridynamics\",horizon=$1}"
}
passage fdm 'method={type="finite_difference"}'
passage fdm_courant_1 run.time_step=auto run.courant=1.0
for horizon in 1 2 4 8; do
    passage "m$horizon" "$(peridynamics "$horizon")"
done

echo "== Figure 7b: three spacings to the horizon; coarser; coarser under a longer pulse"
three=$(peridynamics 3)
passage m3 "$three"
passage m3_coarse "$three" bar.spacing=0.01
passage m3_coarse_long "$three" bar.spacing=0.01 wave.triangle.rise=0.08e-3 wave.triangle.fall=0.16e-3
python3 "$cases/figures_6_7.py" "$results"

echo "== Errors by passage"
python3 "$cases/passages.py" "$results"/fig7_{fdm_courant_1,fdm,m1,m2,m3,m4,m8,m3_coarse,m3_coarse_long} |
    tee "$results/passages.md"
