"""The ground as a continuum: what a brick's springs and disks amount to, and the waves in it."""
