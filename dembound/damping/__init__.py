"""Damping of ground: relaxation mechanisms that make its quality factor nearly constant over a band, or Rayleigh's."""
