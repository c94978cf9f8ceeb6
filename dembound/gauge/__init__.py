"""Estimates from a strain gauge on a bar: wave speed, attenuation, strength."""
