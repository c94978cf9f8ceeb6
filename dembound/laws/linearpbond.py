"""PFC's linear parallel-bond law: contacts without tension and with friction, bonds with a strength.

At rest it is as stiff as the elastic law; how contacts and bonds give way is in kernels/contacts.py.
"""

import numpy as np

from dembound.laws.elastic import Moduli, springs, touching


def pair_lines(
    moduli: Moduli,
    radius_i: np.ndarray,
    radius_j: np.ndarray,
    vectors: np.ndarray,
    *,
    bonded: bool,
    gaps_close: bool = True,
    locked_in: float = 0.0,
) -> np.ndarray:
    """Constants (b, 12) of pairs, in the columns that kernels/contacts.py explains.

    Parameters
    ----------
    moduli : micro-parameters.
    radius_i, radius_j : (b,) m.
    vectors : (b, 2) m, from i to j at the start.
    bonded : whether the pairs have bonds.
    gaps_close : whether pairs with a gap have a contact that pushes once it closes; the elastic law knows none.
    locked_in : part of the overlaps that pushes from the start; with 0 overlapping disks just touch.
    """
    distance = np.hypot(*vectors.T)
    pair = springs(moduli, radius_i, radius_j)
    closed = touching(radius_i, radius_j, distance)
    acts = closed | gaps_close
    overlap = np.maximum(radius_i + radius_j - distance, 0.0)
    has_bond = float(bonded)
    return np.column_stack(
        [
            vectors,
            distance,
            np.where(closed, distance + locked_in * overlap, radius_i + radius_j),
            (radius_i - radius_j) / 2.0,
            np.where(acts, pair.contact_normal, 0.0),
            np.where(acts, pair.contact_shear, 0.0),
            has_bond * pair.bond_normal,
            has_bond * pair.bond_shear,
            has_bond * pair.bending,
            1.0 / pair.area,
            1.5 / pair.bond_radius**2,  # R̄/J
        ]
    )
