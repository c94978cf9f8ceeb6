"""The cases that ``dembound new`` writes: small, commented, and valid as they stand."""

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

BAR_STARTER = """\
# A bar of rock, struck at its left end. The blow comes back from the free right end as tension and breaks a piece off.
# SI units; tension is positive. Keys that are commented out show their defaults.

title = "a bar that spalls"

[bar]
length = 1.0                # m
spacing = 0.001             # m, from node to node; a whole number of them is the length
density = 2620.0            # kg/m3
wave_speed = 2740.0         # m/s; or give youngs_modulus (Pa)
strength = 10e6             # Pa; or give critical_stretch; with neither nothing breaks
# section = 1.0             # m2; or give the diameter (m) of a round bar
# attenuation = 0.0         # 1/m; high frequencies fade by exp(-attenuation * distance)

[method]
type = "patch"              # finite differences, and peridynamics where something is about to break; other types:
                            # "finite_difference", "peridynamics", "switch" (to peridynamics, everywhere at once)
horizon = 3                 # spacings that bonds reach in peridynamics; "finite_difference" has no such key
# trigger = 0.9             # share of the critical stretch at which peridynamics begins ("patch", "switch")
# reach = 4                 # horizons that a zone of it extends beyond what made it ("patch")

# An end without a table is free. A "viscous" right end would absorb the blow, so that nothing comes back; other types:
# "fixed", "velocity", "viscous_input".
# [boundary.right]
# type = "free"

[[load]]
name = "blow"
pressure = 12e6             # Pa, times the wave; pulls where it is negative
wave = "pulse"
# side = "left"             # end that it acts on
# nodes = 1                 # nodes that it is spread over; take the horizon where peridynamics is there from the start

[wave.pulse]
type = "triangle"           # or "cosine", "cubic_spline", "ricker", "sine_burst", "constant", "file" (a measured one)
amplitude = 1.0             # a factor of the pressure; of a "velocity" or "viscous_input" end m/s
rise = 4e-5                 # s
fall = 8e-5                 # s

[[monitor]]
name = "middle"
position = 0.5              # m, from the left end

[[monitor]]
name = "end"
position = 1.0

[run]
duration = 5e-4             # s
# time_step = "auto"        # or seconds; or give the Courant number instead, such as courant = 0.5
# safety = 0.9              # share of the stability limit that "auto" uses

[output]
snapshots = 60              # of the whole bar, the last at the end; a picture over place and time needs ten
# history_interval = 0.0    # s; 0: every step
# energy_interval = 0.0     # s; 0: a hundred over the run
# pictures = true
"""
"""Text of the starter case of a bar."""
