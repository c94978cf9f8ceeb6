"""Errors of bars, from their waves at each frequency."""
