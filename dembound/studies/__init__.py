"""Studies: results computed by building cases and running them."""
