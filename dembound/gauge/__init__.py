"""What a strain gauge on a bar measures: wave speed, attenuation, strength."""
