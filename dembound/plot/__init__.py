"""Pictures, made from result files alone and without a display; one kind of figure per module."""
