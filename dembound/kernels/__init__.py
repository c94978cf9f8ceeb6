"""Compiled loops: arrays and floats in, arrays and floats out. Nothing here raises, prints or reads files."""
