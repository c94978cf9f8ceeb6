"""Arrays of ties between two parts: across the seam of a free field, and to a continuum."""

from typing import NamedTuple

import numpy as np


class Seam(NamedTuple):
    """The forces of a free-field column under the elastic law on k supported nodes across its seam.

    twin : (k,) the column's particle at the same place of the brick, −1 for none; start : (k + 1,) rows of its contacts
    across the seam: neighbour (e,) there, and contact_type (e,), rows of constants (p, 6).
    """

    twin: np.ndarray
    start: np.ndarray
    neighbour: np.ndarray
    contact_type: np.ndarray
    constants: np.ndarray


class SeamEnds(NamedTuple):
    """Ends of a seam for a column under the history-dependent law: start (k + 1,) rows of its contact ends, end (e,).

    force : (4, b) of its contacts, see Contacts.
    """

    start: np.ndarray
    end: np.ndarray
    force: np.ndarray


class WallTies(NamedTuple):
    """Half bonds between particles and the wall of a grid, by its e elements of N × N nodes; see kernels/wall.py.

    Ties are in B blocks of eight (kernels/lanes.py), T = 8B of them with those of no stiffness that fill the last block
    of each element. points : tuple of N numbers, so that N is part of the type. start : (e + 1,) blocks of each
    element. node : (e, N²) its nodes, row by row, and line, theirs in the support table. reach : (e, 4) first and end
    column, first and end row of the nodes that the ties act on. particle, particle_line : (T,) of the particle; twin
    (T,) in the free-field column, −1 for none. along, up : (B·N·8,) values of the element's shape functions along x and
    y at the tie's point; along_slope, up_slope their derivatives, 1/m. corrector : (B·12·8,) m and rad, motion x, y,
    rotation of the bond's middle beyond that of the point, each per unit gradient xx, yy, xy, yx. normal : (2T,)
    components x, then y, from the particle to the point; arm (T,) m. stiffness : (3T,) N/m, N/m and N·m of the half
    bonds. lag : η, s. moved (2N²,), reaction (2N²·8,), field (48,), own (24,) : work space.
    """

    points: tuple[float, ...]
    start: np.ndarray
    node: np.ndarray
    line: np.ndarray
    reach: np.ndarray
    particle: np.ndarray
    particle_line: np.ndarray
    twin: np.ndarray
    along: np.ndarray
    along_slope: np.ndarray
    up: np.ndarray
    up_slope: np.ndarray
    corrector: np.ndarray
    normal: np.ndarray
    arm: np.ndarray
    stiffness: np.ndarray
    lag: float
    moved: np.ndarray
    reaction: np.ndarray
    field: np.ndarray
    own: np.ndarray


class Repeats(NamedTuple):
    """Forces on lines of the support table that are repeated on others: source and target, (r,) each."""

    source: np.ndarray
    target: np.ndarray


class Bearings(NamedTuple):
    """Springs of k nodes on their motion relative to the ground beyond; see kernels/bearing.py.

    node, twin, line : (k,) each node, its twin, −1 for none, and its line in the support table. weight : (k,) in the
    mean motion of all. stiffness : (k, 2) N/m along x and y; rest : (k, 2) m, displacement relative to the ground
    without force. force : (s, 3) N of each line of the support table, work space.
    """

    node: np.ndarray
    twin: np.ndarray
    line: np.ndarray
    weight: np.ndarray
    stiffness: np.ndarray
    rest: np.ndarray
    force: np.ndarray
