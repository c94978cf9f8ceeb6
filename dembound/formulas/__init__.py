"""Errors of a run by formula, without further runs; one idea a file."""
