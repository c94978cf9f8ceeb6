"""The case of a bar that ``dembound new --bar`` writes: small, commented, and valid as it stands."""

STARTER = """\
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
