#!/usr/bin/env bash
# The charts of docs/evidence/charts.md: error against cost of the long bar under P and S pulses, of the external source, of Lamb's
# problem, of a blast, of a hole under plane waves, of Garvin's problem, of the tunnel, of a tunnel below damped soil, of
# L's bar, and of the laws.
#
#   cases/charts/run.sh [RESULTS]      (default: results/charts)
#
# A chart that was stopped is continued where it ended.
set -euo pipefail
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/charts}
mkdir -p "$results"

chart() { # CASE [OPTION ...]
    dembound chart "$cases/$1.toml" "${@:2}" --resume --output "$results"
}

tunnel() { # PATTERN P_WAVE_SPEED PACKING LEFT RIGHT BOTTOM: in another pattern, in which S waves run at 600 m/s, too
    chart tunnel --repeats 1 --name "tunnel_${1,,}" \
        --set "title=\"A tunnel under an SV wave, pattern $1: sides and wider models\"" \
        --set material.p_wave_speed="$2" --set "packing={pattern=\"$1\",size=[300.0,300.0],radius=1.0$3}" \
        --set "boundary.left={type=\"free_field\",$4}" --set "boundary.right={type=\"free_field\",$5}" \
        --set "boundary.bottom={type=\"viscous_input\",wave_s=\"pulse\",$6}"
}

chart rock_bar
chart lamb --quantity displacement
chart blast
chart cavity
chart cavity --name cavity_p --set 'title="A hole under a P wave at 30°: boxes, disks and elements"' \
    --set 'incident.type="p"'
chart garvin
chart long_bar
chart shear_bar
chart external_source --quantity displacement
chart laws
chart laws_spall
chart tunnel
chart soil_tunnel
tunnel A 1200 '' 'beta_p=1' 'beta_p=1' 'half_mass=true'
tunnel B 968.76 ',radius_ratio=1.5,brick=[25.0,25.0],seed=1' 'beta_p=0.7149,beta_s=0.7332' \
    'beta_p=0.7932,beta_s=0.8135' 'beta_p=0.8116,beta_s=0.8402'
