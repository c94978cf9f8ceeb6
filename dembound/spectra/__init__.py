"""Spectra of histories, as functions of arrays: Fourier amplitudes, transfer functions, response spectra."""
