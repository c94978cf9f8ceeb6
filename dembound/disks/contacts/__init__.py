"""Pairs of disks: neighbour search, storage for kernels, constants, forces, breaks, and changes of law."""
