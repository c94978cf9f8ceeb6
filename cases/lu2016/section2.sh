#!/usr/bin/env bash
# Lu & Wang (2016), section 2: dispersion (figure 5). Some seconds.
#
#   cases/lu2016/section2.sh [RESULTS]      (default: results/lu2016)
set -euo pipefail
python3 -c 'import dembound' # ends here, before anything is run, where this is not the Python of dembound
cases=$(cd "$(dirname "$0")" && pwd)
figures=${1:-results/lu2016}/figures
figure="Lu & Wang (2016), fig."
mkdir -p "$figures"

echo "== Figure 5: horizons, spacings, spacings within a horizon, time steps"
dembound dispersion --horizon 1 --horizon 2 --horizon 3 --horizon 4 --horizon 8 --spacing 0.005 \
    --title "$figure 5a: dispersion with horizons of 1 to 8 spacings; 1 is central differences" \
    --output "$figures/fig05a_horizons.png"
dembound dispersion --horizon 3 --spacing 0.005 --spacing 0.01 --spacing 0.02 \
    --title "$figure 5b: dispersion with spacings of 5 to 20 mm" --output "$figures/fig05b_spacings.png"
python3 "$cases/figure5c.py" "$figures/fig05c_same_horizon.png"
dembound dispersion --horizon 3 --spacing 0.005 --time-step 1e-6 --time-step 1e-7 \
    --title "$figure 5d: dispersion with time steps of 1 and 0.1 µs" --output "$figures/fig05d_time_steps.png"
