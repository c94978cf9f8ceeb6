#!/usr/bin/env bash
# Lu & Wang (2016), section 3.2: a pulse that runs to and fro (figures 6 and 7), and how wrong it is at each passage.
# Half a minute.
#
#   cases/lu2016/section32.sh [RESULTS]      (default: results/lu2016)
set -euo pipefail
python3 -c 'import dembound' # ends here, before anything is run, where this is not the Python of dembound
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/lu2016}
mkdir -p "$results"

echo "== Figures 6, 7: finite differences and horizons; coarser; coarser under a longer pulse"
dembound paper lu2016 --figure 6 --figure 7 --output "$results"
dembound run "$cases/fig7.toml" --set run.time_step=auto --set run.courant=1.0 --name fig7_fdm_courant_1 \
    --output "$results"

echo "== Errors by passage"
python3 "$cases/passages.py" "$results"/fig7_{fdm_courant_1,fdm,m1,m2,m3,m4,m8,m3_coarse,m3_coarse_long} |
    tee "$results/passages.md"
