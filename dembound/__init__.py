"""dembound: waves in bonded particles, with artificial boundaries that really absorb."""

__version__ = "0.1.0"
