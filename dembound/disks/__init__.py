"""Bonded disks: scene, contacts, motion, and reports."""
