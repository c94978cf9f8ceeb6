"""Bars as a kind of body, and what is said of them: facts, warnings, summary, meshes for pictures."""
