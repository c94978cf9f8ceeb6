"""Reference implementations of the kernels: the step, one component at a time, and history-dependent pairs."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from dembound.kernels import tables
from dembound.kernels.common import CHUNKS
from dembound.kernels.contacts import BONDED, CLOSED, CLOSES, CLOSING, INTACT, NONE, OPEN, REFERENCE, SHEAR, TENSION
from dembound.laws.law import Limits

Forces = Callable[[np.ndarray, np.ndarray], np.ndarray]
State = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass
class Stepped:
    """Particles under loads and supports, which a law's forces move by central differences.

    inertia (3, n) mass, mass, moment of inertia; load (3, n) or (3, 0); of k supported nodes damping, stiffness,
    prescribed (k, 3) and push (steps, k, 3), the drive, which prescribed components take as their velocity.
    work (2, 7) has the columns of tables.Log, filled for supports and damping.
    """

    inertia: np.ndarray
    load: np.ndarray
    nodes: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    prescribed: np.ndarray
    push: np.ndarray
    step: float
    free: np.ndarray = field(default_factory=lambda: np.ones(3))
    damp: float = 0.0
    work: np.ndarray = field(default_factory=lambda: np.zeros((2, 7)))

    @property
    def count(self) -> int:
        """Number of particles."""
        return self.inertia.shape[1]

    def leapfrog(self, forces: Forces, u: np.ndarray, v: np.ndarray) -> list[State]:
        """(u, v before, v after) of every step from copies of u and v, and the last state once more."""
        states = []
        u, v = u.copy(), v.copy()
        for push in self.push:
            after = self._kicked(forces(u, v), push, u, v)
            states.append((u, v, after))
            u, v = u + self.step * after, after
        return [*states, (u, v, v)]

    def _kicked(self, force: np.ndarray, push: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Velocities half a step on; the work of supports and damping is entered."""
        line = {node: k for k, node in enumerate(self.nodes)}
        force = force + (self.load if self.load.size else 0.0)
        after = np.zeros_like(v)
        whole, half = np.zeros(2), np.zeros(2)
        for c in range(3):
            for i in range(self.count):
                k, m = line.get(i), self.inertia[c, i]
                C, outside, prescribed = 0.0, 0.0, False
                if k is not None:
                    C, prescribed = self.damping[k, c], self.prescribed[k, c]
                    outside = push[k, c] - self.stiffness[k, c] * u[c, i]
                # Cundall's damping acts on the whole unbalanced force, applied ones included
                drag = 0.0 if prescribed else -self.damp * abs(force[c, i] + outside) * np.sign(v[c, i])
                # m (v⁺ − v)/Δt = F − C (v⁺ + v)/2
                F = force[c, i] + outside + drag
                moved = ((m / self.step - C / 2.0) * v[c, i] + F) / (m / self.step + C / 2.0)
                after[c, i] = (push[k, c] if prescribed else moved) * self.free[c]
                mean = 0.5 * (v[c, i] + after[c, i])
                support = 0.0 if k is None else outside - C * mean
                if prescribed:
                    support = m * (after[c, i] - v[c, i]) / self.step - force[c, i]
                whole += np.array([support, -drag]) * mean * self.step
                half += np.array([support, -drag]) * 0.5 * v[c, i] * self.step
        self.work[1, :2] = self.work[0, :2] + half
        self.work[0, :2] += whole
        return after

    def bundles(self) -> tuple[tables.Body, tables.Supports, tables.Log]:
        """Body, supports and log as bundles for the kernels, with a log of all particles."""
        unsupported = np.ones(self.count)
        unsupported[self.nodes] = 0.0
        body = tables.Body(
            unsupported * self.step / self.inertia[0],
            unsupported * self.step / self.inertia[2],
            self.free,
            self.load,
            self.damp,
            self.step,
        )
        inertia = self.inertia[:, self.nodes].T / self.step
        mobility = np.where(self.prescribed, 0.0, self.free / (inertia + 0.5 * self.damping))
        keep = mobility * (inertia - 0.5 * self.damping)
        prescribed = self.prescribed.astype(float)
        drive = self.push * self.free
        k = len(self.nodes)
        nobody, nothing = np.full(k, -1), np.zeros((k, 3))
        supports = tables.Supports(
            self.nodes, inertia, keep, mobility, self.stiffness, prescribed, drive, nobody, nothing
        )
        everyone = np.arange(self.count)
        record, peaks = np.empty((len(self.push), self.count, 6)), np.zeros((self.count, 3, 2))
        top_speed, work = np.zeros(self.count), np.zeros((2, 7))
        return body, supports, tables.Log(everyone, record, everyone, peaks, top_speed, work, np.zeros(1))


def stepped(count: int, steps: int, step: float, *, supported: bool = True, loaded: bool = True, **more) -> Stepped:
    """Particles of random masses under random loads and five supports, the last prescribed in x and rotation."""
    rng = np.random.default_rng(3)
    nodes = np.arange(2, count, count // 5)[:5] if supported else np.zeros(0, dtype=np.int64)
    shape = (len(nodes), 3)
    prescribed = np.zeros(shape, dtype=bool)
    prescribed[4:, [0, 2]] = True
    mass, inertia = rng.uniform(0.5, 2.0, (2, count))
    load = rng.uniform(-0.1, 0.1, (3, count))
    damping, stiffness = rng.uniform(0.0, 2.0, (2, *shape))
    push = rng.uniform(-0.1, 0.1, (steps, *shape))
    load = load if loaded else np.zeros((3, 0))
    return Stepped(np.stack([mass, mass, inertia]), load, nodes, damping, stiffness, prescribed, push, step, **more)


@dataclass
class PlainPairs:
    """Copied history-dependent pairs, one at a time.

    `lost` is the energy taken by friction, cracks, opening and closing.
    """

    arrays: tables.Contacts
    limits: Limits
    lost: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        self.arrays = copied(self.arrays)

    def push(self, u: np.ndarray, v: np.ndarray, step: float, number: int) -> np.ndarray:
        """Forces and moments (3, n) of all pairs, whose history is updated.

        Arrays.force gets the forces of each pair.
        """
        total = np.zeros_like(u)
        for c in range(len(self.arrays.first)):
            i, j = int(self.arrays.first[c]), int(self.arrays.second[c])
            on_i, moment_i, moment_j = self._push_one(c, u[:, i], u[:, j], v[:, i], v[:, j], step, number)
            self.arrays.force[:, c] = [*on_i, moment_i, moment_j]
            total[:, i] += [*on_i, moment_i]
            total[:, j] += [*-on_i, moment_j]
        return total

    def began(self, c):
        """Stretch, shear and rotation (3,) that a pair has from the start."""
        began = self.arrays.began
        return np.zeros(3) if len(began) == 0 else began[self.arrays.contact_type[c]]

    def strain(self, c, u_i, u_j, v_i, v_j, step):
        """Normal, arms, stretch, shear and its velocity along the normal of a pair."""
        p, geometry = self.arrays, self.limits.geometry
        row, began = p.constants[p.contact_type[c]], self.began(c)
        apart, along = (u_j - u_i)[:2], (v_j - v_i)[:2]
        still = geometry == REFERENCE or (geometry == BONDED and p.state[c] == INTACT)
        vector = row[:2] if still else row[:2] + apart
        length = np.hypot(*vector)
        n = vector / length
        t = np.array([-n[1], n[0]])
        arms = np.array([length / 2.0 + row[4], length / 2.0 - row[4]])
        stretch = (n @ apart if still else length - row[2]) + began[0]
        slide = t @ along - arms @ [v_i[2], v_j[2]]
        shear = t @ apart - arms @ [u_i[2], u_j[2]] + began[1] if still else p.shear[c] + step * slide
        return n, t, arms, stretch, shear, n @ along, slide

    def _push_one(self, c, u_i, u_j, v_i, v_j, step, number):
        """Force on the first disk, and the moments on both."""
        p, limits = self.arrays, self.limits
        _, _, rest, touch, _, k_n, k_s, b_n, b_s, b_m, per_area, bend = p.constants[p.contact_type[c]]
        n, t, arms, stretch, shear, opening, slide = self.strain(c, u_i, u_j, v_i, v_j, step)
        before, p.shear[c] = shear - step * slide, shear
        push, rub = k_n * (touch - rest - stretch), k_s * (shear - p.slip[c])
        if limits.geometry != REFERENCE or touch < rest:
            overlap, overlapped = push / k_n, push / k_n + step * opening
            push = max(push, 0.0)
            # the push one step earlier, by work and by what it had stored
            pushed = k_n * max(overlapped, 0.0)
            stored = 0.5 * (push**2 - pushed**2) / k_n
            was_open = p.closed[c] == OPEN
            pushed *= CLOSING if p.closed[c] == CLOSES else 1.0
            if overlapped <= 0.0:
                push *= CLOSING
            p.closed[c] = OPEN if overlap <= 0.0 else (CLOSES if overlapped <= 0.0 else CLOSED)
            if p.state[c] != INTACT and overlap <= 0.0 and was_open and limits.geometry != REFERENCE:
                p.shear[c] = p.slip[c] = 0.0
                return np.zeros(2), 0.0, 0.0  # open before and after
            self.lost[2] += 0.5 * (pushed + push) * (overlap - overlapped) - stored
            if abs(rub) > limits.friction * push:
                rub_before, slip_before = k_s * (before - p.slip[c]), p.slip[c]
                rub = np.sign(rub) * limits.friction * push
                p.slip[c] = shear - rub / k_s
                rubbed = 0.5 * (rub_before + rub) * (p.slip[c] - slip_before)
                self.lost[0 if rubbed > 0.0 else 2] += rubbed
            keeps = limits.geometry == REFERENCE or (limits.geometry == BONDED and p.state[c] == INTACT)
            if overlap <= 0.0 and not keeps and p.state[c] != INTACT:
                p.shear[c] = p.slip[c] = 0.0
        force, moment = -push * n + rub * t, 0.0
        side = rub
        if p.state[c] == INTACT:
            turn, turning = u_j[2] - u_i[2] + self.began(c)[2], v_j[2] - v_i[2]
            tension = b_n * stretch * per_area + abs(b_m * turn) * bend
            strength = limits.cohesion - b_n * stretch * per_area * limits.tan_fa
            if tension >= limits.tension or abs(b_s * shear) * per_area >= strength:
                p.state[c] = TENSION if tension >= limits.tension else SHEAR
                p.cracked[c], p.closed[c] = number, CLOSED
                # ½ k s⁻ s: what forces at whole steps have stored by the step at which they are gone
                broken = 0.5 * b_n * stretch * (stretch - step * opening)
                broken += 0.5 * b_s * shear * before + 0.5 * b_m * turn * (turn - step * turning)
                if limits.geometry == BONDED:  # from here on the contact has its true length
                    longer = np.hypot(*(p.constants[p.contact_type[c], :2] + (u_j - u_i)[:2])) - rest + self.began(c)[0]
                    overlaps = [max(touch - rest - each, 0.0) for each in (stretch, longer)]
                    broken += 0.5 * k_n * (overlaps[0] ** 2 - overlaps[1] ** 2)
                self.lost[1 if broken > 0.0 else 2] += broken
            else:
                force = force + b_n * stretch * n + b_s * shear * t
                side, moment = side + b_s * shear, b_m * turn
        return force, arms[0] * side + moment, arms[1] * side - moment


def contacts_of(count: int, vectors: np.ndarray, **columns: np.ndarray) -> tables.Contacts:
    """A list of pairs as kernels take it, each with a row of constants of its own in the order of the pairs.

    vectors (b, 2); columns first, second, state (b,); touch, offset, normal, shear, bond_normal, bond_shear, bending,
    area, bond_radius (b,); began (3, b) strain at the start, absent: none.
    """
    first, second = columns["first"], columns["second"]
    b = len(first)
    names = ("touch", "offset", "normal", "shear", "bond_normal", "bond_shear", "bending")
    springs = [columns[name] for name in names]
    bonds = [1.0 / columns["area"], 1.5 / columns["bond_radius"] ** 2]  # R̄/J with J = 2 R̄³/3
    constants = np.ascontiguousarray(np.column_stack([vectors, np.hypot(*vectors.T), *springs, *bonds]))
    unread = np.full((1, 3), np.nan)[:0]
    began = np.ascontiguousarray(columns["began"].T) if "began" in columns else unread
    owner, end = np.concatenate([first, second]), np.concatenate([2 * np.arange(b), 2 * np.arange(b) + 1])
    return tables.Contacts(
        0,
        True,
        first.astype(np.uint32),
        second.astype(np.uint32),
        np.arange(b, dtype=np.uint32),
        constants,
        began,
        columns["state"].astype(np.uint8),
        np.zeros(b),
        np.zeros(b),
        np.full(b, CLOSED, np.uint8),
        np.full(b, -1),
        np.full((b, 2), np.nan),
        np.zeros(b, np.uint8),
        np.zeros((4, b)),
        np.zeros((2, 0)),
        np.zeros((2, 0)),
        np.zeros((0, 0)),
        np.zeros(0),
        np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=count))]).astype(np.uint32),
        end[np.argsort(owner, kind="stable")].astype(np.uint32),
        np.linspace(0, b, CHUNKS + 1).astype(np.int64),
    )


def random_pairs(count: int, b: int, gap: float = 0.05) -> tables.Contacts:
    """A list of b pairs of n disks, 1 to 2 apart: half overlap, half do not, by `gap`; two in three are bonded."""
    rng = np.random.default_rng(11)
    pairs = np.array([rng.choice(count, 2, replace=False) for _ in range(b)])
    angle, length = rng.uniform(0.0, 2.0 * np.pi, b), rng.uniform(1.0, 2.0, b)
    normal, shear, bond_normal, bond_shear = rng.uniform(0.5, 2.0, (4, b))
    bond_radius = rng.uniform(0.3, 0.5, b)
    return contacts_of(
        count,
        (length * [np.cos(angle), np.sin(angle)]).T,
        first=pairs[:, 0],
        second=pairs[:, 1],
        state=np.where(np.arange(b) % 3 < 2, INTACT, NONE),
        touch=length + gap * np.where(np.arange(b) % 2, 1.0, -1.0),
        offset=0.1 * rng.uniform(-1.0, 1.0, b),
        normal=normal,
        shear=shear,
        bond_normal=bond_normal,
        bond_shear=bond_shear,
        bending=bond_normal * bond_radius**2 / 3.0,
        area=2.0 * bond_radius,
        bond_radius=bond_radius,
        began=0.02 * rng.uniform(-1.0, 1.0, (3, b)),
    )


def one_pair(state: int = NONE, overlap: float = 0.0) -> tables.Contacts:
    """One pair along x of two disks of radius 1 that touch: k_n = 4, k_s = 2; bond 3, 1, bending 0.5, A = 2."""
    constants = {"offset": 0.0, "normal": 4.0, "shear": 2.0, "bond_normal": 3.0, "bond_shear": 1.0, "bending": 0.5}
    constants |= {"touch": 2.0 + overlap, "area": 2.0, "bond_radius": 1.0}
    columns = {name: np.array([value]) for name, value in constants.items()}
    pair = {"first": np.array([0]), "second": np.array([1]), "state": np.array([state])}
    return contacts_of(2, np.array([[2.0, 0.0]]), **pair, **columns)


def copied(pairs: tables.Contacts) -> tables.Contacts:
    """Pairs with columns of their own."""
    return tables.Contacts(*pairs[:2], *(column.copy() for column in pairs[2:]))


def alone(pairs: tables.Contacts, c: int) -> tables.Contacts:
    """Pair c of several, with columns of its own."""
    names = ("first", "second", "contact_type", "state", "shear", "slip", "closed", "cracked", "place", "kept")
    one = {name: getattr(pairs, name)[c : c + 1].copy() for name in names}
    bound = np.minimum(np.arange(CHUNKS + 1), 1)
    return pairs._replace(**one, force=pairs.force[:, c : c + 1].copy(), bound=bound)


def behind(pairs: tables.Contacts, others: int) -> tables.Contacts:
    """Pairs whose particles are numbered anew: there are as many others before them."""
    first, second = ((ends + others).astype(np.uint32) for ends in (pairs.first, pairs.second))
    start = np.concatenate([np.zeros(others, dtype=np.uint32), pairs.start])
    return copied(pairs)._replace(begin=others, first=first, second=second, start=start)
