"""Numba extended by what kernels need: lanes of eight numbers, bundles by address, kernels compiled separately."""
