"""Sweeps: a case run, or calibrated, with many values of its keys, by several processes or a cluster."""
