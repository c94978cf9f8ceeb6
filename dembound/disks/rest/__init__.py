"""The static stage: tractions and loading, the way to rest, what has settled."""
