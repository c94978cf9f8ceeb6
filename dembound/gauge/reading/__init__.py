"""Measured signals: columns of text files from oscilloscopes, their units, and gauges in the records of runs."""
