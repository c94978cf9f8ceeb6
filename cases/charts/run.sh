#!/usr/bin/env bash
# The charts of docs/charts.md: error against cost of the long bar, of Lamb's problem and of L's bar.
#
#   cases/charts/run.sh [RESULTS]      (default: results/charts)
#
# A chart that was stopped is continued where it ended.
set -euo pipefail
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/charts}
mkdir -p "$results"

dembound chart "$cases/rock_bar.toml" --resume --output "$results"
dembound chart "$cases/lamb.toml" --quantity displacement --resume --output "$results"
dembound chart "$cases/long_bar.toml" --resume --output "$results"
