#!/usr/bin/env bash
# Lu & Wang (2016), section 2: dispersion (figure 5). Some seconds.
#
#   cases/lu2016/section2.sh [RESULTS]      (default: results/lu2016)
set -euo pipefail
python3 -c 'import dembound' # ends here, before anything is run, where this is not the Python of dembound
results=${1:-results/lu2016}

echo "== Figure 5: horizons, spacings, spacings within a horizon, time steps"
dembound paper lu2016 --figure 5 --output "$results"
