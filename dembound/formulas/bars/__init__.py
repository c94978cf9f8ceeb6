"""Formulas for the errors of bars."""
