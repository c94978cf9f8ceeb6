"""The ground beyond the sides: continuum and its ties to the disks, cut bonds, incoming waves, excavated edges."""
