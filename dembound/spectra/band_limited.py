"""The band-limited function through even samples."""

import numpy as np


def band_limited(values: np.ndarray, finer: int) -> np.ndarray:
    """The band-limited function through even samples (n,) that are zero outside, `finer` times as often.

    It is the sum of a sinc at every sample. Returns ((n − 1)·finer + 1,) values from the first to the last sample,
    themselves among them. As many zeros as samples keep both ends apart, since the Fourier transform is periodic.
    """
    from scipy.fft import irfft, next_fast_len, rfft

    length = int(next_fast_len(2 * len(values), real=True))
    spectrum = rfft(values, length)
    if length % 2 == 0:  # it stands for both signs of the highest frequency, in the finer spectrum for one
        spectrum[-1] *= 0.5
    fine = np.asarray(finer * irfft(spectrum, finer * length))[: (len(values) - 1) * finer + 1].copy()
    fine[::finer] = values
    return fine
