"""The ground as a continuum: the homogenised stiffness of a brick, and the waves in it."""
