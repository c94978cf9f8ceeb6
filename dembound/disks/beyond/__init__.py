"""What lies beyond the sides: continuum and its ties to the disks, cut bonds, waves that come in, excavated edges."""
