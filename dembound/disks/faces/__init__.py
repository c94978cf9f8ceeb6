"""Joints, planes of weakness in the ground: the faces that disks have on them, and their forces."""
