"""An elastic continuum of spectral elements, with a layer that absorbs waves."""
