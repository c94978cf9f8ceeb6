#!/usr/bin/env bash
# Lu & Wang (2016): everything that is reproduced, table 1 and figure 8 here, the rest in section2.sh, section32.sh and
# section33.sh. Takes some four minutes.
#
#   cases/lu2016/run.sh [RESULTS]      (default: results/lu2016)
set -euo pipefail
python3 -c 'import dembound' # ends here, before anything is run, where this is not the Python of dembound
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/lu2016}
mkdir -p "$results"

echo "== Table 1, figure 8: seven bars that spall"
dembound paper lu2016 --figure 8 --output "$results"
python3 "$cases/table1.py" "$results" | tee "$results/table1.md"

for section in 2 32 33; do
    bash "$cases/section$section.sh" "$results"
done
echo "figures and tables are in $results"
