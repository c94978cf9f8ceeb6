"""How near ground is to failure under its weight: factor of safety and yield acceleration."""
