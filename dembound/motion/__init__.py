"""Motion of all kinds of bodies: the state, parts and ties, the loop, trackers and the energy ledger."""
