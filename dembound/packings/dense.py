"""Dense random packing of disks in a periodic box, with or without fixed rows."""

import logging
import math
from dataclasses import dataclass

import numpy as np

from dembound.errors import PackingError
from dembound.packings.bed import Bed
from dembound.packings.brick import Brick, contact_stress, contact_vectors, listed, strip_order

LOGGER = logging.getLogger(__name__)

# force balance: of the first compression, while loose disks grow, and of the finished brick
ROUGH, MEDIUM, FINE = 1e-3, 1e-4, 1e-9
SIZE_TOLERANCE = 2e-3  # of the mean radius
MAX_STARTS = 30  # about one start in four succeeds with 100 disks: 0.75³⁰ = 2e-4 of the bricks fail
MAX_CROWDINGS = 200  # rounds of growing loose disks; about 20 are usual
CROWDED = 5e-4  # pressure over E_c below which loose disks are fitted into their room, as steps of growth are too large
PRESSING = 10.0  # rounds after which fitted disks press twice as much: some take turns in being loose
STAGE = 3.0  # ratio of two pressures in which looser beds are made: linear in the radii, they do not fall apart
TOUCH = 1e-9  # of the mean radius: row disks that touch exactly have gaps of round-off size


@dataclass(frozen=True)
class RegularRows:
    """Disks held in place while the core is packed: positions (h, 2) m, radii (h,) m, member (h, 2) bool."""

    positions: np.ndarray
    radii: np.ndarray
    member: np.ndarray


NO_ROWS = RegularRows(np.empty((0, 2)), np.empty(0), np.empty((0, 2), bool))


@dataclass(frozen=True)
class Recipe:
    """All parameters of a dense brick.

    size (2,) m; radius the mean core radius m; radius_ratio largest over smallest; pressure the confining
    stress over E_c; bond_gap m; seed of the random start.
    """

    size: tuple[float, float]
    radius: float
    radius_ratio: float
    pressure: float
    bond_gap: float
    seed: int


def radius_range(radius: float, radius_ratio: float) -> tuple[float, float]:
    """The smallest and the largest radius (m) of a uniform distribution with this mean radius (m)."""
    smallest = 2.0 * radius / (1.0 + radius_ratio)
    return smallest, radius_ratio * smallest


def pack_dense(recipe: Recipe, rows: RegularRows = NO_ROWS) -> Brick:
    """Pack a brick: random start, overlap energy minimised, radii scaled to the given stress.

    While the error of the mean core radius is above 0.2 %, another start with a better number of disks is tried: a
    large brick needs one or two starts, small ones more. Raises PackingError when the stress, the force balance or the
    mean radius cannot be reached.
    """
    count = first_count(recipe, rows)
    LOGGER.info("packing a brick of %s disks", f"{count + len(rows.radii):,}")
    best, crowding = math.inf, recipe.pressure >= CROWDED
    estimates = []  # of the number of disks that would give the mean radius, one from each start
    for attempt in range(MAX_STARTS):
        try:
            bed, crowding = pack_count(count, recipe, rows, attempt, crowding=crowding)
        except PackingError:
            if attempt == MAX_STARTS - 1:
                raise
            crowding = False
            continue
        factor = float(bed.radii[bed.held :].mean()) / recipe.radius
        if abs(factor - 1.0) <= SIZE_TOLERANCE:
            return finish(bed, recipe, rows)
        best = min(best, abs(factor - 1.0))
        estimates.append(count * factor**2)
        count = max(round(sum(estimates) / len(estimates)), 1)
    raise PackingError(
        f"the error of the mean radius was at least {100.0 * best:.2f} % in {MAX_STARTS} starts with about {count} "
        "disks; a larger brick scatters less"
    )


def first_count(recipe: Recipe, rows: RegularRows) -> int:
    """Number of core disks expected to fill the box at the given pressure."""
    # solid fractions measured at radius ratios 1 to 4 and pressures 5e-4 to 0.1
    solid = (0.832 + 0.005 * recipe.radius_ratio) * (1.0 + 3.0 * recipe.pressure)
    room = solid * math.prod(recipe.size) - math.pi * float(np.sum(rows.radii**2))
    smallest, largest = radius_range(recipe.radius, recipe.radius_ratio)
    mean_square = (smallest**2 + smallest * largest + largest**2) / 3.0
    return max(round(room / (math.pi * mean_square)), 1)


def pack_count(
    count: int, recipe: Recipe, rows: RegularRows, attempt: int, *, crowding: bool = True
) -> tuple[Bed, bool]:
    """A bed that starts with `count` core disks, in equilibrium at the pressure, without loose disks.

    crowding : whether loose disks grow by steps; if that leaves some, or else, they are fitted into their room. Also
    returns whether growing was enough.
    """
    rng = np.random.default_rng([recipe.seed, attempt])
    box = np.array(recipe.size)
    core = rng.random((count, 2)) * box
    core = core[strip_order(core, 4.0 * recipe.radius)]
    # evenly spaced, not random: the mean and the range are exact
    radii = rng.permutation(np.linspace(*radius_range(recipe.radius, recipe.radius_ratio), count))
    bed = Bed(box, np.vstack([rows.positions, core]), np.concatenate([rows.radii, radii]), len(rows.radii))
    bed.compress(max(recipe.pressure, CROWDED), ROUGH)
    if crowding and settled(bed, recipe.pressure, fitting=False):
        return bed, True
    for pressure in stages(recipe.pressure):
        if not settled(bed, pressure, fitting=True, final=pressure == recipe.pressure):
            loose = bed.loose()
            raise PackingError(
                f"{int(loose.sum())} of {len(loose)} disks still have fewer than three contacts after "
                f"{MAX_CROWDINGS} rounds of fitting them between their neighbours"
            )
    return bed, False


def stages(pressure: float) -> list[float]:
    """Pressures over E_c, the last of which is `pressure`, in which a bed comes to one below `CROWDED`."""
    steps = max(math.ceil(math.log(CROWDED / pressure, STAGE)), 0)
    return [pressure * STAGE**step for step in range(steps, -1, -1)]


def settled(bed: Bed, pressure: float, *, fitting: bool, final: bool = True) -> bool:
    """Bring a bed to rest at a pressure (over E_c) without loose disks.

    fitting : whether these are fitted into their room, pressing more from round to round, or grow by steps. final :
    whether to the last digits. Returns whether it succeeded within `MAX_CROWDINGS` rounds.
    """
    tolerance = MEDIUM
    bed.compress(pressure, tolerance, hasten=fitting)
    for number in range(MAX_CROWDINGS):
        loose = bed.loose()
        if loose.any():
            bed.fill_cages(loose, 1.0 + number / PRESSING) if fitting else bed.crowd(loose)
            tolerance = MEDIUM
        elif tolerance == FINE or not final:
            return True
        else:
            tolerance = FINE
        bed.compress(pressure, tolerance, hasten=fitting)
    return False


def finish(bed: Bed, recipe: Recipe, rows: RegularRows) -> Brick:
    """The brick of a bed in equilibrium: sorted disks, contacts, stress and residual force ratio."""
    from dembound.kernels import pack

    member = np.zeros((len(bed.radii), 2), bool)
    member[: bed.held] = rows.member
    order = strip_order(bed.positions, 4.0 * recipe.radius)
    positions, radii, member = bed.positions[order], bed.radii[order], member[order]
    pairs, images, near = listed(positions, radii, bed.box, recipe.bond_gap + TOUCH * recipe.radius)
    vectors = contact_vectors(positions, pairs, images, bed.box)
    overlaps = radii[pairs].sum(axis=1) - np.hypot(*vectors.T)
    free = ~member.any(axis=1)
    forces = np.empty((2, len(radii)))
    mean = pack.overlap_forces(positions.T.copy(), near, forces, np.empty((3, pack.BLOCK)))
    return Brick(
        size=bed.box,
        positions=positions,
        radii=radii,
        pairs=pairs,
        images=images,
        edge_rows=member,
        stress=contact_stress(vectors, overlaps, bed.box),
        residual_ratio=float(np.hypot(*forces[:, free]).mean() / mean),
    )
