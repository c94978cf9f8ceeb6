"""Bonded disks: their scene, contacts, motion, and what is reported of them."""
