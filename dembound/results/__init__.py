"""Records of runs: writing, reading, comparing, and files for ParaView."""
