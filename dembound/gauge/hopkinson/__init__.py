"""Split Hopkinson tests: pulses cut from signals on both bars; stress, strain and strain rate of the specimen."""
