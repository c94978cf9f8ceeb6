"""The static stage: tractions and loading, the path to rest, the settled body."""
