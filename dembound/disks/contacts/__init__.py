"""Pairs of disks: which are near, where kernels hold them, their constants, forces, breaks, and changes of law."""
