"""Studies: questions answered by building cases and running them."""
