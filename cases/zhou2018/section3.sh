#!/usr/bin/env bash
# Zhou et al. (2018), section 3: the external-source bar (figure 14) and Lamb's problem (figure 16), on the isotropic
# lattice beside the exact half-space, and on the paper's own lattice without friction. About ten minutes on two cores.
#
#   cases/zhou2018/section3.sh [RESULTS]      (default: results/zhou2018)
set -euo pipefail
cases=$(cd "$(dirname "$0")" && pwd)
results=${1:-results/zhou2018}
figures=$results/figures
mkdir -p "$figures"

echo "== Figure 14: external source"
dembound run "$cases/external_source.toml" --output "$results"
dembound plot "$results/external_source" --quantity displacement --output "$figures/fig14_external_source.png"

echo "== Figure 16: Lamb's problem on the isotropic lattice"
for sides in viscous viscoelastic extended; do
    dembound run "$cases/lamb_$sides.toml" --output "$results"
done
dembound exact "$cases/lamb_viscous.toml" --name lamb_exact --output "$results"
dembound plot "$results"/lamb_{exact,extended,viscoelastic,viscous} --quantity displacement \
    --output "$figures/fig16_lamb_isotropic.png"
dembound compare "$results"/lamb_{exact,extended,viscoelastic,viscous} --quantity displacement

echo "== A continuum beyond the sides, and disks only at the load"
dembound run "$cases/lamb_viscous.toml" --set 'boundary.right={type="outside"}' \
    --set 'boundary.bottom={type="outside"}' --name lamb_outside --output "$results"
dembound run "$cases/lamb_window.toml" --output "$results"
dembound compare "$results"/lamb_{exact,outside,window} --quantity displacement
dembound compare "$results"/lamb_{extended,window} --quantity displacement

echo "== Figure 16 on the paper's lattice: no friction, so contacts carry no shear"
for law in elastic linearpbond; do
    for sides in extended viscoelastic viscous; do
        dembound run "$cases/lamb_$sides.toml" --set material.fric=0.0 --set material.law=$law \
            --name "lamb_${sides}_$law" --output "$results"
    done
    dembound plot "$results"/lamb_{extended,viscoelastic,viscous}_$law --quantity displacement \
        --output "$figures/fig16_lamb_fric0_$law.png"
    dembound compare "$results"/lamb_{extended,viscoelastic,viscous}_$law --quantity displacement
done
echo "figures are in $figures"
