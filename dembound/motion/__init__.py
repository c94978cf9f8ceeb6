"""How anything moves: the state, parts and ties, the loop, trackers and the energy ledger; no kind of body."""
