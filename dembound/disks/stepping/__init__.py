"""Stepping: disks, free-field column and continuum as parts, ties between them, stress, balance at rest."""
