"""The case of disks that ``dembound new`` writes: small, commented, and valid as it stands."""

STARTER = """\
# A bar of equal disks. A P pulse enters at the left, runs along the bar and leaves at the right.
# SI units; two dimensions mean unit thickness. Keys that are commented out show their defaults.

title = "a pulse along a bar"

[packing]
pattern = "A"               # "A" square lattice, "B" random brick, "C" random brick with regular edges
size = [100.0, 5.0]         # m, the scene; a whole number of disks (A) or bricks (B, C)
radius = 0.25               # m, mean radius of the disks

[material]
density = 2500.0            # kg/m3, bulk
p_wave_speed = 1000.0       # m/s; or give the moduli emod and pb_emod (Pa)
# match = "lattice"         # "assembly": the packing itself, not the square lattice, gets that speed along x
# contact_share = 0.5       # share of the stiffness that contacts carry; parallel bonds carry the rest

[motion]
held = ["y"]                # motions no particle makes: any of "x", "y", "rotation"

# A side without a table is free. Positive velocities point along +x and +y.
[boundary.left]
type = "viscous_input"      # absorbs, and lets the wave in
wave_p = "pulse"            # moves along the side's normal; wave_s moves across it
# beta_p = 1.0              # factor of the P dashpots; `dembound calibrate` finds it

[boundary.right]
type = "viscous"            # absorbs; "viscoelastic" absorbs and holds; other types: "free", "fixed",
                            # "roller", "symmetry", "velocity", "periodic", "viscoelastic_input"

[wave.pulse]
type = "cosine"             # or "cubic_spline", "triangle", "ricker", "sine_burst", "constant", "file"
amplitude = 0.5             # m/s
period = 0.08               # s

[[monitor]]
name = "middle"
position = [50.0, 2.5]      # m, from the lower left corner

[run]
duration = 0.3              # s
# time_step = "auto"        # or seconds
# safety = 0.9              # share of the stability limit that "auto" uses

[output]
snapshots = 5               # whole-scene snapshots, the last at the end
# history_interval = 0.0    # s; 0: every step
# energy_interval = 0.0     # s; 0: a hundred over the run
# pictures = true
"""
"""Text of the starter case, of disks."""
