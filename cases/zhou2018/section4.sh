#!/usr/bin/env bash
# Zhou et al. (2018), section 4: free-field sides, without a tunnel beside other sides, and with one (figures 17 and 18)
# in patterns A, B and C, beside a continuum solution and beside wider and deeper models. A quarter of an hour and 3 GB
# on two cores; the continuum solution needs scikit-fem.
#
#   cases/zhou2018/section4.sh [RESULTS]      (default: results/zhou2018)
set -euo pipefail
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/zhou2018}
figures=$results/figures

needs() { # PACKAGE MODULE: ends here, before anything is run, where python3 has no such module
    python3 -c "import importlib.util, sys; sys.exit(importlib.util.find_spec('$2') is None)" || {
        echo "$(basename "$0"): needs the Python package $1 in $(command -v python3); pip install $1" >&2
        exit 1
    }
}
needs dembound dembound
needs scikit-fem skfem
mkdir -p "$figures"

errors() { # RUN REFERENCE: along x, along y and both
    python3 "$cases/tunnel_errors.py" "$results/$1" "$results/$2"
}

echo "== No tunnel: free-field, viscous, free and fixed sides; the free-field run moves as its column does"
places='monitor=[{name="middle",position=[150.0,150.0]},{name="quarter",position=[75.0,150.0]},{name="edge",position=[2.0,150.0]},{name="surface",position=[150.0,299.5]},{name="corner",position=[2.0,299.5]}]'
runs=()
for side in free_field viscous free fixed; do
    dembound run "$cases/tunnel.toml" --set 'hole=[]' --set "$places" --set "boundary.left={type=\"$side\"}" \
        --set "boundary.right={type=\"$side\"}" --name "sides_$side" --output "$results"
    runs+=("$results/sides_$side")
done
dembound compare "${runs[@]}"
dembound plot "${runs[@]}" --monitor middle --monitor edge --monitor surface --output "$figures/sides.png"

echo "== Figures 17, 18: the tunnel in patterns C, B and A, and the continuum"
dembound run "$cases"/tunnel{,_b,_a}.toml --output "$results"
python3 "$cases/tunnel_continuum.py" --name continuum_homogenised --p-wave-speed 934.1 --s-wave-speed 584.2 \
    --output "$results" # pattern C's own speeds, from `dembound check`
python3 "$cases/tunnel_continuum.py" --name continuum_z --level 0.5 --output "$results"
dembound plot "$results"/{continuum_homogenised,continuum_z,tunnel,tunnel_a,tunnel_b} --monitor P1 --monitor P2 \
    --output "$figures/fig18_tunnel.png"
dembound compare "$results"/{continuum_homogenised,tunnel}
dembound compare "$results"/{continuum_z,tunnel,tunnel_a,tunnel_b}
errors tunnel continuum_homogenised
for case in tunnel tunnel_a tunnel_b; do errors $case continuum_z; done

echo "== Pattern A with friction: isotropic, c_p = 1000 m/s and c_s = 707.1 m/s"
isotropic=(--set material.fric=0.5 --output "$results")
dembound run "$cases/tunnel_a.toml" "${isotropic[@]}" --name tunnel_a_isotropic
python3 "$cases/tunnel_continuum.py" --name continuum_isotropic --p-wave-speed 1000 --s-wave-speed 707.1 --level 0.5 \
    --output "$results"
errors tunnel_a_isotropic continuum_isotropic

echo "== Scattered motion beside models five times as wide and three times as deep"
wide=(--set 'packing.size=[1500.0,900.0]' --set run.duration=3.3 --set output.snapshots=0 --set output.pictures=false
    --set 'hole=[{name="tunnel",type="circle",centre=[750.0,750.0],radius=20.0}]'
    --set 'monitor=[{name="P1",position=[729.5,750.0]},{name="P2",position=[750.0,770.5]}]')
for case in tunnel tunnel_b tunnel_a; do
    dembound run "$cases/$case.toml" "${wide[@]}" --name "${case}_extended" --output "$results"
    errors $case ${case}_extended
done
dembound run "$cases/tunnel_a.toml" "${wide[@]}" "${isotropic[@]}" --name tunnel_a_isotropic_extended
errors tunnel_a_isotropic tunnel_a_isotropic_extended
echo "== Disks only round the tunnel, the rest a continuum, beside ground all of disks with a continuum beyond its sides"
dembound run "$cases/tunnel_window.toml" --output "$results"
dembound run "$cases/tunnel_window.toml" --set 'packing.size=[300.0,300.0]' --set 'packing.origin=[0.0,0.0]' \
    --set 'boundary.top={type="free"}' --set output.snapshots=0 --name tunnel_ground --output "$results"
errors tunnel_window tunnel_ground
echo "figures are in $figures"
