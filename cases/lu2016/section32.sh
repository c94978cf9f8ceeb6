#!/usr/bin/env bash
# Lu & Wang (2016), section 3.2: a pulse that runs to and fro (figures 6 and 7), and how wrong it is at each passage.
# Half a minute.
#
#   cases/lu2016/section32.sh [RESULTS]      (default: results/lu2016)
set -euo pipefail
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/lu2016}
mkdir -p "$results/figures"

echo "== Figures 6, 7a: finite differences and four horizons"
dembound run "$cases"/fig7_*.toml --output "$results"
dembound run "$cases/fig7_fdm.toml" --set run.time_step=auto --set run.courant=1.0 --name fig7_fdm_courant_1 \
    --output "$results"

echo "== Figure 7b: three spacings to the horizon; coarser; coarser under a longer pulse"
three=("$cases/fig7_m1.toml" --set method.horizon=3 --output "$results")
dembound run "${three[@]}" --name fig7_m3
dembound run "${three[@]}" --set bar.spacing=0.01 --name fig7_m3_coarse
dembound run "${three[@]}" --set bar.spacing=0.01 --set wave.triangle.rise=0.08e-3 --set wave.triangle.fall=0.16e-3 \
    --name fig7_m3_coarse_long
python3 "$cases/figures_6_7.py" "$results"

echo "== Errors by passage"
python3 "$cases/passages.py" "$results"/fig7_{fdm_courant_1,fdm,m1,m2,m3,m4,m8,m3_coarse,m3_coarse_long} |
    tee "$results/passages.md"
