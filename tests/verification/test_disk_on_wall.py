import numpy as np
import pytest

LOOSE = {"law": "linearpbond", "emod": 1e9, "pb_emod": 0.0, "fric": 0.5, "kratio": 1.0}
R = 0.25


def on(lab, points, at, **wall):
    """A disk of radius R at a place on or above a wall through these points, under weight along `down`."""
    words = {"load": [{"acceleration": wall.pop("down")}]} if "down" in wall else {}
    return lab.disks([at], [R], held=(), material=LOOSE, wall=[{"points": points, **wall}], **words)


def slope(angle):
    t, n = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    return t, n


def test_slide(lab):
    angle = np.radians(30.0)
    t, n = slope(angle)
    for mu, held in ((0.2, ("rotation",)), (0.0, ()), (0.2, ())  , (1.0, ())):
        over = 1500*9.81*np.cos(angle)  # guess
        scene = lab.disks([R * n], [R], held=held, material=LOOSE, wall=[{"points": [(-50*t).tolist(), (5*t).tolist()], "fric": mu, "dp_nratio": 0.5}], load=[{"acceleration": [0.0, -9.81]}])
        sim = lab.simulation(scene)
        led = lab.ledger(sim, 500)
        T=0.5
        N=int(T/sim.time_step)
        sim.run(N); v0=sim.state.velocity[:,0].copy()
        sim.run(2*N); v1=sim.state.velocity[:,0].copy()
        a=-(v1-v0)[:2]@t/(N*sim.time_step)
        alpha=(v1-v0)[2]/(N*sim.time_step)
        print(mu, held, a/9.81, np.sin(angle)-mu*np.cos(angle), 2/3*np.sin(angle), alpha*R/9.81, led.entries[-1])
