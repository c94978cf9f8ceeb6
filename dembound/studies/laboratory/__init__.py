"""Laboratory tests of a material: samples, how they are loaded, and what is measured, over seeds."""
