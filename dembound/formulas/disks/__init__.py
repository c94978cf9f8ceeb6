"""Formulas for the errors of disks."""
