"""The runs of a library: one for each input, and one without waves where something else acts."""

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import tomli_w

from dembound.casefile import Case
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import BOND_KEYS
from dembound.casefile.model import as_kind
from dembound.casefile.reader import parsed
from dembound.casefile.tables import ENDING
from dembound.casefile.types import LAWS
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError
from dembound.files import remove
from dembound.kinds import loads, with_changes
from dembound.motion.kind import Plan
from dembound.results.folder import Folder
from dembound.results.text_files import write_json
from dembound.running import Progress, plan, run_case, warnings_before
from dembound.version import __version__

FILE = "library.json"
"""File that describes a library in its folder; it is written last, so its library is complete."""

REST = "rest"
"""Name of the run without waves."""

HAT = "hat_"
"""Beginning of the name of the run under one triangle of an input, before the input's name."""

WHOLE = 1e-9
"""Part of a time step by which a time may differ from a whole number of them."""

CHOSEN = (*ENDING, "time_step", "duration")
"""Keys of ``[run]`` that a library chooses."""


def inputs_of(case: DiskCase) -> list[str]:
    """The waves that act on a case, in the order of their names: each is an input."""
    return sorted(case.entering | {load.wave for load in case.load if load.wave is not None})


def problems_of(case: DiskCase) -> Iterator[str]:
    """Reasons why a case has no library, a line each: it is not linear, has no input, or nothing is recorded."""
    law, damp = case.material.law, case.material.damp
    linear = " or ".join(f'"{name}"' for name, each in LAWS.items() if each.is_linear)
    if not LAWS[law].is_linear:
        why = "whose contacts open, slide and break" if LAWS[law].has_history else "which is not linear"
        yield f'material.law: is "{law}", {why}; a library adds up motion, so {linear}'
    if any(not joint.is_linear for joint in case.joint):
        yield "joint: parts and slides, so motion does not add up as in a library; leave fric out, or the joints"
    if case.group:
        yield "group: a library is of ground without groups; leave them out"
    if damp > 0.0:
        yield f"material.damp: is {damp:g}, must be 0 in a library, as local damping is not linear"
    if not inputs_of(case):
        yield "wave: none acts on this case; a library needs one, in whose place records are put"
    if not case.monitor:
        yield "monitor: there is none; a library has the histories of monitors"


def is_at_rest(case: DiskCase) -> bool:
    """Whether a scene does not move without waves, as it has neither steady loads nor a static stage."""
    return case.static is None and all(load.wave is not None for load in case.load)


@contextmanager
def unwatched(name: str) -> Iterator[Progress]:
    """A progress that ignores everything."""
    yield Progress()


def build_library(
    case: DiskCase,
    spacing: float,
    results: Path,
    duration: float | None = None,
    progress_of: Callable[[str], AbstractContextManager[Progress]] = unwatched,
) -> Path:
    """Run the inputs of a case one by one, and write ``results/<case name>_library/``; returns that folder.

    Each input is a triangle of 1 m/s (of a load's factor: 1) that rises over the spacing and falls over it. Everything
    else is as in the case, the settings of a continuum as chosen for its own waves; the time step is the largest
    whole fraction of the spacing that is not above the case's own.

    Parameters
    ----------
    spacing : time between two values of the records, s. duration : of the longest record, s; None: of the case.
    progress_of : returns the progress of a run, given its name.

    Raises CaseError for a case that is not linear, and if the spacing is not a multiple of a given step; else errors as
    of `run_case`.
    """
    if problems := list(problems_of(case)):
        raise CaseError(problems, case.name)
    planned: Plan[DiskScene] = plan(case)
    with progress_of(case.name) as progress:
        for warning in warnings_before(planned):
            progress.warned(warning)
    if planned.scene.outside is not None:  # its settings as keys, so that they do not depend on the waves
        given = planned.scene.outside.settings.given
        planned = plan(with_changes(planned.scene.case, {f"outside.{key}": value for key, value in given.items()}))
    waves = planned.scene.ground_waves
    # a wave of [incident] that passes the first disks before its point would else begin within a run
    lead = 0 if waves is None else math.ceil(waves.across / spacing)
    base = _base(planned, spacing, case.run.duration if duration is None else duration, lead)
    folder = results / f"{case.name}_library"
    remove(folder / FILE)
    names = inputs_of(case)
    plain, triangle = _of_runs(base, lead * spacing), _triangle(spacing, lead * spacing)
    cases = [] if is_at_rest(case) else [under(plain, {}, REST)]
    cases += [under(_settled(plain, folder), {name: triangle}, f"{HAT}{name}") for name in names]
    for each in cases:
        Folder(folder, each.name).check()
    for each in cases:
        with progress_of(each.name) as progress:
            run_case(each, folder, _WithoutWarnings(progress))
    facts: dict[str, Any] = {"version": __version__, "name": case.name, "spacing": spacing, "lead": lead}
    facts |= {"inputs": names, "case": base.text}
    write_json(folder / FILE, facts)
    return folder


def under(
    base: DiskCase, waves: Mapping[str, Mapping[str, Any]], name: str, files: Mapping[str, str] | None = None
) -> DiskCase:
    """The case of a library under other waves, which have tables; inputs without one remain silent.

    name : of the case. files : texts of the files that the tables refer to.
    """
    data = parsed(base.text)
    data["wave"] |= {key: dict(table) | _motion_of(base, key) for key, table in waves.items()}
    return _of_disks(loads(tomli_w.dumps(data), base.folder, name, files))


def _motion_of(case: DiskCase, name: str) -> dict[str, str]:
    """The key motion of a wave, which holds for the records in its place."""
    motion = case.wave[name].motion
    return {} if motion is None else {"motion": motion}


def _of_disks(case: Case) -> DiskCase:
    """The case as a case of disks."""
    return as_kind(case, DiskCase, "is the case of a bar")


def _base(planned: Plan[DiskScene], spacing: float, duration: float, lead: int) -> DiskCase:
    """The case with the step, the duration and the output of a library, and inputs that begin after all its runs.

    lead : spacings that triangles begin after a run, and that records are zero after their first value.
    """
    case = planned.scene.case
    time_step = _time_step(case, planned.time_step, spacing)
    steps, most = round(spacing / time_step), max(1, round(case.output.history_interval / time_step))
    stride = next(divisor for divisor in range(min(most, steps), 0, -1) if steps % divisor == 0)
    run = {key: value for key, value in case.run.given().items() if key not in CHOSEN}
    run |= {"time_step": time_step, "duration": duration}
    output = {"history_interval": stride * time_step, "snapshots": 0, "pictures": False}
    output |= {"load_factor": case.output.load_factor}
    silent = _triangle(spacing, 2.0 * (duration + lead * spacing))
    waves = {name: silent | _motion_of(case, name) for name in inputs_of(case)}
    return with_changes(case, {"run": run, "output": output, "wave": waves})


def _of_runs(base: DiskCase, longer: float) -> DiskCase:
    """The case of the runs: longer by a time (s), and without load factor and strengths, which it does not need."""
    data = parsed(base.text)
    data["run"]["duration"] += longer
    data["output"].pop("load_factor")
    for table in (data["material"], *data.get("layer", ())):
        for key in BOND_KEYS:
            table.pop(key, None)
    return _of_disks(loads(tomli_w.dumps(data), base.folder, base.name, base.files))


def _settled(base: DiskCase, folder: Path) -> DiskCase:
    """The case with the settled state of the run without waves, if it has a static stage that is kept."""
    if base.static is None or base.static.from_ is not None or base.run.checkpoint == 0.0:
        return base
    return with_changes(base, {"static.from": str(folder / REST)})


def _triangle(spacing: float, start: float) -> dict[str, Any]:
    """The table of a triangle of unit height, twice as long as the spacing (s)."""
    return {"type": "triangle", "amplitude": 1.0, "rise": spacing, "fall": spacing, "start": start}


def _time_step(case: DiskCase, usual: float, spacing: float) -> float:
    """The time step (s), a whole fraction of the spacing; usual : time step of the case."""
    steps = spacing / usual
    if case.run.time_step == "auto":
        return spacing / math.ceil(steps - WHOLE)
    if abs(steps - round(steps)) > WHOLE * steps or round(steps) < 1:
        must = f"a whole fraction of the spacing, {spacing / max(1, math.ceil(steps)):.10g} s"
        raise CaseError([f'run.time_step: is {usual:g} s, must be {must}, or "auto"'])
    return usual


class _WithoutWarnings(Progress):
    """Passes on progress without warnings, as warnings about triangles and silence do not concern the case."""

    def __init__(self, progress: Progress) -> None:
        self.settling, self.running = progress.settling, progress.running  # type: ignore[method-assign]
