"""Errors of bonded disks: by formulas, by companions of larger disks, and beside exact motion."""
