"""Pictures, made only from result files and without a display; one kind of figure per module."""
