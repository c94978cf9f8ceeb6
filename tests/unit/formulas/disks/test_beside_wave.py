"""Errors by sides along a wave: axes and sides, the undisturbed ground, scenes without such sides."""

import numpy as np
import pytest
from small_cases import small

from dembound.disks.scene import build
from dembound.formulas.disks.beside_wave import taken_from_waves
from dembound.formulas.disks.coarse_grid import Grid, undisturbed

SPEED, PERIOD = 1000.0, 0.02


def scene_of(driven: str, along: dict, motion: str = "s", **others):
    """A lattice of 16 × 10 disks, the longer side along the wave's front, with two monitors on the way of the wave."""
    upright = driven in ("bottom", "top")
    size = [16.0, 10.0] if upright else [10.0, 16.0]
    depths = (2.5, 9.5) if driven in ("bottom", "left") else (7.5, 0.5)
    places = [[4.5, depth] if upright else [depth, 4.5] for depth in depths]
    sides = ("left", "right") if upright else ("bottom", "top")
    tables = {
        "packing": {"pattern": "A", "size": size, "radius": 0.5},
        "material": {"density": 2500.0, "p_wave_speed": SPEED, "fric": 0.5},
        "boundary": {driven: {"type": "viscous_input", f"wave_{motion}": "pulse"}} | dict.fromkeys(sides, along),
        "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": PERIOD}},
        "monitor": [{"name": name, "position": place} for name, place in zip("ab", places, strict=True)],
        "run": {"duration": 0.08},
    }
    return build(small(tables, changes=others))


def shares(*of, **others) -> list[float]:
    (found,) = taken_from_waves(scene_of(*of, **others))
    return list(found.shares.values())


@pytest.mark.parametrize(
    ("motion", "along"), [("p", {"type": "viscous"}), ("s", {"type": "viscoelastic", "distance": 10.0})]
)
def test_waves_from_all_sides_are_alike(motion: str, along: dict) -> None:
    up = shares("bottom", along, motion)
    assert min(up) > 0.1
    for driven in ("top", "left", "right"):
        assert shares(driven, along, motion) == pytest.approx(up, rel=1e-9)


def test_the_undisturbed_ground_carries_the_wave_and_its_surface_doubles_it() -> None:
    grid = Grid.of(scene_of("bottom", {"type": "viscous"}, "p"), 1)
    lengths = [grid.weights(side).sum() for side in ("left", "right", "bottom", "top")]
    assert lengths == pytest.approx([10.0, 10.0, 16.0, 16.0])
    step = grid.time_step
    times = step * np.arange(int(0.08 / step))
    incoming = np.zeros((len(times), 2))
    incoming[:, 1] = np.where(times < PERIOD, 0.5 - 0.5 * np.cos(2.0 * np.pi * times / PERIOD), 0.0)
    ground = undisturbed(grid, "bottom", incoming, np.zeros_like(incoming), step)

    # 1 m/s comes in; waves of 20 elements a period lose 1 % of their peak on the way
    assert np.abs(ground.v[:, -1, 1]).max() == pytest.approx(2.0, rel=0.02)
    # the surface sends them back through the bottom
    assert np.abs(ground.v[-5:]).max() < 0.02
    assert not ground.v[:, :, 0].any()


@pytest.mark.parametrize(
    "along",
    [{"type": "free"}, {"type": "fixed", "artificial": False}, {"type": "free_field"}],
    ids=["free", "a true wall", "free field"],
)
def test_sides_that_end_the_body_or_whose_ground_moves_are_not_asked_about(along: dict) -> None:
    assert list(taken_from_waves(scene_of("bottom", along))) == []


@pytest.mark.parametrize(
    "along", [{"type": "roller"}, {"type": "symmetry"}, {"type": "fixed"}], ids=lambda t: t["type"]
)
def test_walls_and_mirrors_hold_what_moves_across_them(along: dict) -> None:
    """Rollers and mirrors do not disturb a wave that moves along them."""
    assert min(shares("bottom", along)) > 0.5
    moving = scene_of("bottom", along, **{"boundary.bottom": {"type": "viscous_input", "wave_p": "pulse"}})
    taken = [share for found in taken_from_waves(moving) for share in found.shares.values()]
    assert (max(taken) < 1e-12) == (along["type"] != "fixed")


def test_places_that_the_wave_has_not_reached_have_no_share() -> None:
    """At 707 m/s it takes 3.5 ms to one monitor and 13 ms to the other; explicit steps move that by rounding."""
    assert len(shares("bottom", {"type": "viscous"}, **{"run.duration": 0.012})) == 1
    assert len(shares("bottom", {"type": "viscous"}, **{"run.duration": 0.02})) == 2
