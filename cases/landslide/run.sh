#!/usr/bin/env bash
# A landslide between artificial sides, from its earthquake to its deposit, and the same ground in a rigid box whose base
# and sides shake with the record, as in most studies with particles: what the artificial boundaries change.
# Runs, a picture, a movie and a page; some seven minutes of one core.
#
#   cases/landslide/run.sh [RESULTS]      (default: results/landslide)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/landslide}

dembound run "$here/landslide.toml" --output "$results"
dembound run "$here/landslide.toml" --output "$results" --name rigid_box \
    --set 'boundary.left={type="velocity", wave_p="record", hold=["normal"]}' \
    --set 'boundary.right={type="velocity", wave_p="record", hold=["normal"]}' \
    --set 'boundary.bottom={type="velocity", wave_s="record"}' \
    --set 'wave.record.motion="within"'
python3 "$here/compare.py" "$results/landslide" "$results/rigid_box" "$results/landslide.png"
dembound movie "$results/landslide" --field displacement --no-histories --size 700 --output "$results/landslide.gif"
dembound report "$results/landslide" "$results/rigid_box" --output "$results/landslide.html"
