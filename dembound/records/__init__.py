"""Measured ground motions: readers of the formats that networks publish, processing, and measures of a motion."""
