"""Compiled loops: arrays and floats in, arrays and floats out. Nothing here raises, prints or reads files."""

import os

# Threads wait for each other at every step. Where other programs use the cores too, waiting by spinning makes a run
# many times slower; the variable is read when the first parallel loop starts.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")
