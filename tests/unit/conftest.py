"""Small cases and a small recorded run that many tests start from."""

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
import pytest
from readable import drawn_quickly
from small_cases import PUSHED, SPALLING, SURROUNDED, small
from typer.main import get_command

from dembound import cli
from dembound.casefile import Case
from dembound.cli import compiling
from dembound.continuum.axis import Around
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.disks.contacts.layout import contact_rows
from dembound.disks.scene import DiskScene
from dembound.kinds import loads, with_changes
from dembound.kinds.disks.kind import Disks
from dembound.motion.energy import Ledger
from dembound.motion.kind import Plan
from dembound.motion.simulation import Simulation
from dembound.motion.trackers import NEVER
from dembound.results.recorder import Recorder
from dembound.results.recording import Histories, Snapshots
from dembound.running import plan
from dembound.starting import starting_point

STARTER = starting_point()


def record(path: Path, name: str, snapshots: int) -> Path:
    """Run the case, 20 × 5 disks in P and S motion, under a name; the snapshots are evenly spaced."""
    planned = plan(small(PUSHED, name))
    half, quarter = planned.steps // 2, planned.steps // 4
    return recorded(path, planned, half + snapshots * quarter, [half + k * quarter for k in range(snapshots)])


class At(Snapshots):
    """Snapshots at some steps."""

    def __init__(self, recorder: Recorder, steps: Sequence[int]) -> None:
        self.at = sorted(steps)
        super().__init__(recorder, 0, 1)

    def _after(self, step: int) -> None:
        self._next = next((later for later in self.at if later > step), NEVER)


def recorded(path: Path, planned: Plan, steps: int, shots: Sequence[int], entries: Sequence[int] = ()) -> Path:
    """Record a number of steps of a plan, with snapshots at some steps and two or more entries of the ledger."""
    simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
    ledger = Ledger(simulation, entries[1] - entries[0]) if len(entries) > 0 else None
    with Recorder(path, simulation, planned.step_limit, ledger=ledger) as recorder:
        simulation.track(Histories(recorder), At(recorder, shots), *([ledger] if ledger else []))
        simulation.run(steps)
    return path


@pytest.fixture(scope="session")
def small_run(tmp_path_factory) -> Path:
    """The record of a run called ``small`` with two snapshots."""
    return record(tmp_path_factory.mktemp("small") / "run.h5", "small", 2)


@pytest.fixture(scope="session")
def other_run(tmp_path_factory) -> Path:
    """The record of a shorter run called ``other``, without snapshots."""
    return record(tmp_path_factory.mktemp("other") / "run.h5", "other", 0)


@pytest.fixture(scope="session")
def long_run(small_run, tmp_path_factory) -> Path:
    """The record of the small run with the last two of 10,001 snapshots, which HDF5 lists in the other order."""
    path = tmp_path_factory.mktemp("long") / "run.h5"
    path.write_bytes(small_run.read_bytes())
    with h5py.File(path, "r+") as file:
        for number, later in (("0000", "9999"), ("0001", "10000")):
            file.move(f"snapshots/{number}", f"snapshots/{later}")
        assert list(file["snapshots"]) == ["10000", "9999"]
    return path


@pytest.fixture(scope="session")
def rich_run(small_run, tmp_path_factory) -> Path:
    """The record of the small run with stresses in its snapshots, and with peaks."""
    path = tmp_path_factory.mktemp("rich") / "run.h5"
    path.write_bytes(small_run.read_bytes())
    rng = np.random.default_rng(8)
    with h5py.File(path, "r+") as file:
        count = len(file["particles/radius"])
        file["particles/peak_velocity"] = rng.uniform(0.1, 0.5, count)
        for snapshot in file["snapshots"].values():
            snapshot["stress"] = rng.normal(0.0, 1e6, (count, 3))
    return path


BRITTLE = {
    "material.law": "linearpbond",
    "material.pb_ten": 1e6,
    "material.pb_coh": 1e6,
    "wave.push.amplitude": -1.0,
    "wave.push.start": 0.002,
    "wave.shake.amplitude": 2.0,
    "wave.shake.start": 0.002,
    "output.contacts": True,
}
"""Bonds that break in tension and in shear where their end is pulled away and sideways, but not at once."""


@pytest.fixture(scope="session")
def cracked_run(tmp_path_factory) -> Path:
    """The record of a run called ``cracked`` whose bonds break, with two snapshots and two entries of the ledger."""
    planned = plan(small(PUSHED, "cracked", BRITTLE))
    half = 1 + planned.steps // 2
    path = tmp_path_factory.mktemp("cracked") / "run.h5"
    return recorded(path, planned, 2 * half, [half, 2 * half], range(0, 2 * half, half))


@pytest.fixture(scope="session")
def surrounded_run(tmp_path_factory) -> Path:
    """The record of disks in a continuum, called ``surrounded``, in random motion in its two snapshots."""
    scene = Disks().build(small(SURROUNDED, "surrounded", {"output.peaks": True, "output.stress": True}))
    simulation, rng = Simulation(scene, 1e-4), np.random.default_rng(3)
    path = tmp_path_factory.mktemp("surrounded") / "run.h5"
    with Recorder(path, simulation, 2e-4) as recorder:
        for step in (50, 100):
            simulation.state.step = step
            simulation.state.displacement = 1e-3 * rng.normal(size=(3, scene.count)) * scene.moves
            simulation.state.velocity = rng.normal(size=(3, scene.count)) * scene.moves
            simulation.state.top_speed = rng.uniform(1.0, 2.0, scene.count)
            recorder.snapshot()
    return path


@pytest.fixture(scope="session")
def spalled_run(tmp_path_factory) -> Path:
    """The record of the spalling bar, called ``spalled``, with twelve snapshots and twelve entries of the ledger."""
    planned = plan(small(SPALLING, "spalled"))
    part = planned.steps // 12
    path = tmp_path_factory.mktemp("spalled") / "run.h5"
    return recorded(path, planned, 12 * part, range(part, 13 * part, part), range(0, 12 * part, part))


@pytest.fixture
def spalling() -> Callable[..., Case]:
    """Makes cases: the spalling bar with keys changed."""

    def make(changes: Mapping[str, Any] | None = None, name: str = "spalling") -> Case:
        return small(SPALLING, name, changes)

    return make


BAR = {
    "packing.size": [10.0, 1.0],
    "wave.pulse.period": 0.01,
    "monitor": [{"name": "middle", "position": [5.0, 0.5]}],
    "run.duration": 0.01,
    "output.snapshots": 1,
    "output.pictures": False,
}


@pytest.fixture
def bar() -> Callable[..., Case]:
    """Makes cases: the starter's bar cut down to 20 × 2 disks and 29 steps, with keys changed."""

    def make(changes: Mapping[str, Any] | None = None, name: str = "bar") -> Case:
        return with_changes(loads(STARTER, Path(), name), {**BAR, **(changes or {})})

    return make


@pytest.fixture
def unstable() -> Callable[[], AbstractContextManager[None]]:
    """Makes a context in which disks run with twice their largest stable step."""
    from dembound.kinds.disks import kind

    @contextmanager
    def with_long_steps() -> Iterator[None]:
        stable = kind.choose_step
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(kind, "choose_step", lambda scene: (2.0 * stable(scene)[1], stable(scene)[1]))
            yield

    return with_long_steps


@pytest.fixture
def felt() -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    """Makes the signal of a gauge at 0.6 m of a bar of 0.99 m with waves of 2740 m/s, sampled at 1 MHz.

    A compressive triangle of unit height enters after 20 µs and runs to and fro between free ends; noise is the
    standard deviation of added noise over the largest tension.
    """

    def feel(
        rise: float = 40e-6, fall: float = 80e-6, attenuation: float = 0.52, noise: float = 0.0, seed: int = 0
    ) -> tuple[np.ndarray, np.ndarray]:
        time = 1e-6 * np.arange(5000)
        stress = np.zeros_like(time)
        for turn in range(8):
            for sign, way in ((-1.0, 1.98 * turn + 0.6), (1.0, 1.98 * turn + 1.38)):
                since = time - 20e-6 - way / 2740.0
                triangle = np.clip(np.minimum(since / rise, 1.0 - (since - rise) / fall), 0.0, 1.0)
                stress += sign * np.exp(-attenuation * way) * triangle
        return time, stress + noise * stress.max() * np.random.default_rng(seed).standard_normal(len(time))

    return feel


@pytest.fixture(scope="session")
def in_order() -> Callable[[DiskScene], DiskScene]:
    """Makes a scene's kernels hold its particles in their order, as those of a scene of one brick do."""

    def make(scene: DiskScene) -> DiskScene:
        rows = (contact_rows(scene.assembly.part(part), scene.ground, part.start) for part in scene.parts.values())
        return replace(scene, slots=None, rows=tuple(rows))

    return make


ROCK = Medium(2500.0, c11=9e9, c22=7e9, c12=2e9, c66=3e9, c16=0.4e9, c26=-0.3e9)
"""A medium without any symmetry."""


def uneven(order: int) -> Mesh:
    """Elements of three widths and heights, also within layers, round a buried box of 5.5 m × 2 m."""
    return Mesh(
        order=order,
        widths=(3.0, 2.5, 2.5, 3.0, 2.5, 2.5, 2.0, 2.0, 3.0),
        heights=(2.5, 2.0, 1.5, 2.0, 1.5, 1.5),
        origin=(-8.0, -6.0),
        box=(3, 3, 5, 4),
        layer=Around(2, 2, 2, 0),
    )


@pytest.fixture
def grid() -> Callable[..., GridBody]:
    """Makes continua: elements of 3 × 2 m round a box of 2 × 1 of them that reaches the top, with other keys.

    Or the elements of `uneven`.
    """

    def make(order: int = 4, medium: Medium = ROCK, first_slot: int = 0, even: bool = True, **more: Any) -> GridBody:
        mesh = Mesh.around((0.0, 0.0, 6.0, 2.0), (3.0, 2.0), order, margin=Around(1, 2, 1, 0), layer=Around(2, 2, 2, 0))
        return GridBody(mesh=mesh if even else uneven(order), medium=medium, first_slot=first_slot, **more)

    return make


@pytest.fixture
def noise() -> Callable[[GridBody], np.ndarray]:
    """Makes random fields (3, n) of the nodes of a body that move, without rotation."""

    def make(body: GridBody, seed: int = 0) -> np.ndarray:
        field = np.random.default_rng(seed).standard_normal((3, body.count)) * ~body.mesh.held
        field[2] = 0.0
        return field

    return make


class Answer(NamedTuple):
    """Exit code and output of a command."""

    code: int
    out: str
    err: str


@pytest.fixture(scope="session")
def command() -> Callable[[], None]:
    """The application as `app()` makes it; a tenth of the time of these tests would go into making it every time."""
    return get_command(cli.app)


@pytest.fixture
def dembound(tmp_path, monkeypatch, capsys, command) -> Callable[..., Answer]:
    """Runs a command in an empty folder as the shell would, with small pictures."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys.modules["dembound.cli.entry"], "app", command)
    drawn_quickly(monkeypatch)
    monkeypatch.setattr(compiling, "report_compiling", lambda: None)  # else what is printed depends on earlier tests

    def run(*arguments: object) -> Answer:
        monkeypatch.setattr(sys, "argv", ["dembound", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        return Answer(ended.value.code or 0, *capsys.readouterr())

    return run


@pytest.fixture
def written(bar, tmp_path) -> Callable[..., Path]:
    """Writes cases of the small bar to files."""

    def write(name: str = "bar", changes: dict | None = None) -> Path:
        path = tmp_path / f"{name}.toml"
        path.write_text(bar(changes).text, encoding="utf-8")
        return path

    return write
