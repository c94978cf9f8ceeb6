"""Measured signals: columns of text files from oscilloscopes, and their units."""
