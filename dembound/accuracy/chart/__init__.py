"""Charts: a case run over many choices of its keys, and the error of each against its cost."""
