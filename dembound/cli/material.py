"""Commands about a material: tests of its samples, and what contacts and bonds make of it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer
from typer import Argument, Option

from dembound.cli.app import MORE, Name, Output, Scheduler, Settings, app, few, load_disks, require_one_place, text_for
from dembound.cli.calibration import OneCase
from dembound.cli.console import ending_with, err, out, print_lines, print_rows, print_written
from dembound.cli.options import leave, with_tables
from dembound.cli.sweep import FAILED, cells_of, print_failed, shown
from dembound.errors import CaseError
from dembound.studies.asked import Loading
from dembound.words import percent, with_unit

if TYPE_CHECKING:
    from dembound.casefile.disks.material import Material
    from dembound.casefile.disks.model import DiskCase
    from dembound.results.recording import TestName
    from dembound.studies.laboratory.sample import Sample
    from dembound.studies.laboratory.study import Tested
    from dembound.studies.laboratory.tables import Ratio
    from dembound.studies.sweep.study import Options, Standing
    from dembound.studies.sweep.tables import Statistic


@dataclass(frozen=True)
class LoadingOptions(Loading):
    """Samples, how they are loaded, and where they run."""

    processes: Annotated[
        int | None, Option("--processes", "-p", min=1, help="Samples at once; as many as cores by default.")
    ] = None
    scheduler: Scheduler = None

    def sample(self, case: DiskCase, test: str) -> Sample:
        """The sample of a test of the material of a case; raises CaseError as `sample_of`."""
        from dembound.studies.laboratory.sample import sample_of

        return sample_of(case, test, self)

    def options(self, *, anew: bool = False) -> Options:
        """Options of the sweep over seeds; raises CaseError for processes beside a scheduler."""
        from dembound.studies.sweep.study import Options

        require_one_place(self.scheduler, self.processes)
        return Options(processes=self.processes, scheduler=self.scheduler, anew=anew)

    @property
    def given(self) -> Iterator[str]:
        """Names of the options that differ from their defaults."""
        for field in fields(self):
            if getattr(self, field.name) != field.default:
                yield f"--{field.name}"


PRINTED = {
    "strength": "strength",
    "first_crack": "first crack",
    "young": "E of the sample",
    "poisson": "ν of the sample",
    "young_plane_strain": "E, plane strain",
    "poisson_plane_strain": "ν, plane strain",
    "strain_at_peak": "strain at the peak",
    "tension_cracks_at_peak": "broken in tension, at the peak",
    "shear_cracks_at_peak": "broken in shear, at the peak",
    "friction_angle": "friction angle φ",
    "cohesion": "cohesion",
    "uniaxial": "strength at no pressure, of the line",
}
"""Quantities that are printed, and their names there; all others are in the files."""


@app.command("test")
@with_tables
def laboratory(
    kind: Annotated[str, Argument(metavar="TEST", help="ucs, tension, brazilian or biaxial.")],
    case: Annotated[Path, Argument(metavar="CASE", help="A case file (TOML) of disks with strengths.")],
    *,
    seeds: Annotated[int, Option(min=1, callback=few, help="Samples, of seeds packing.seed and above.")] = 4,
    pressures: Annotated[
        str | None, Option(metavar="PA,PA,…", help="Pressures at the sides, for biaxial, e.g. 0,5e6,10e6.")
    ] = None,
    shares: Annotated[str, Option(metavar="LOW,HIGH", help="Shares of the peak between which E is taken.")] = "0.1,0.5",
    anew: Annotated[bool, Option("--anew", help="Also repeat samples that are done.")] = False,
    output: Output = Path("results"),
    changes: Settings = None,
    name: Name = None,
    loading: LoadingOptions,
) -> None:
    """Test samples of a material: E, ν, first crack, strength.

    Only the tables packing and material of the case count; pressures at the sides give friction angle and cohesion.

    Each sample is a case of its own, which is left with the results.

    Complete samples are not repeated: the same command continues a test, and more seeds add samples to it.
    """
    from dembound.studies.laboratory.sample import ignored
    from dembound.studies.laboratory.study import perform, specimens_of
    from dembound.studies.laboratory.tables import ratios_of

    options = loading.options(anew=anew)
    between, sides = _numbers("--shares", shares), _numbers("--pressures", pressures) if pressures else None
    loaded = load_disks(case, changes, name)
    sample = loading.sample(loaded, kind)
    if unused := ignored(loaded):
        err.print(f"{loaded.name}: only [packing] and [material] count; not used: {', '.join(unused)}")
    specimens = specimens_of(sample, seeds, sides)
    err.print(f"{loaded.name}: {kind}, {sample.in_words}")
    folder = output / f"{loaded.name}_{kind}"
    with (
        ending_with(f"{loaded.name}: stopped; the same command continues what is left"),
        shown(loaded.name, "samples", lambda standing: _under_way(sample, folder, standing)) as report,
    ):
        found = perform(sample, specimens, options, folder, report, between)
    ratios = list(ratios_of(found, output))
    has_failed = _print(found, ratios)
    _leave(found, ratios)
    if has_failed:
        raise typer.Exit(FAILED)


def _numbers(option: str, text: str) -> list[float]:
    """Numbers between commas; raises CaseError for anything else."""
    try:
        return [float(each) for each in text.split(",")]
    except ValueError:
        raise CaseError([f"{option}: is {text}, must be numbers with commas between them"]) from None


def _under_way(sample: Sample, folder: Path, standing: Standing) -> str:
    """The strains between platens that the samples under way have come to; others are packed, compiled or at rest."""
    from dembound.studies.sweep.perform import times_in

    strains = [percent(sample.strain_at(time)) for time in sorted(times_in(folder).values())]
    preparing = standing.under_way - len(strains)
    words = [f"strain {', '.join(strains)}"] if strains else []
    words += [f"{preparing} preparing"] if preparing > 0 else []
    return f" ({'; '.join(words)})" if words else ""


def _print(tested: Tested, ratios: Sequence[Ratio]) -> bool:
    """Print failures, warnings, means and ratios; returns whether a run has failed."""
    name = tested.sample.case.name
    members = [each.member for each in tested.specimens]
    failed = print_failed(name, members, tested.states, tested.warnings_of_runs, "samples")
    for line in tested.warnings:
        err.print(f"{name}: warning: {line}")
    found = [each for each in tested.statistics if each.quantity in PRINTED]
    if found:
        print_rows(name, list(_rows(found)), left=2 if any(each.group for each in found) else 1)
    for ratio in ratios:
        out.print(f"{name}: compressive over tensile strength {ratio.value:.3g}, with {ratio.folder}")
    return failed > 0


def _rows(statistics: Sequence[Statistic]) -> Iterator[Sequence[str]]:
    """A head, and a row for each quantity and pressure, with three digits; all digits are in the files."""
    from dembound.studies.laboratory.study import UNITS

    grouped = any(each.group for each in statistics)
    yield *(("pressure",) if grouped else ()), "quantity", "n", "mean", "spread", "95 % ±", "unit"
    for each in statistics:
        group = (with_unit(each.group["pressure"], "Pa") if each.group else "all",) if grouped else ()
        yield *group, PRINTED[each.quantity], *cells_of(each, UNITS.get(each.quantity, "1"))


def _leave(tested: Tested, ratios: Sequence[Ratio]) -> None:
    """Write tables, cases and pictures, printing each."""
    from dembound.studies.laboratory.tables import write_tables

    print_written(*write_tables(tested, ratios))
    if not tested.done:
        return
    from dembound.plot.laboratory import plot_curves, plot_envelope, plot_sample

    title, first = f"{tested.sample.case.name}: {tested.sample.test}", tested.done[0]
    leave(plot_curves(title, tested.curves), tested.folder / "curves.png")
    leave(plot_sample(tested.record(first), tested.curves[first.member.name]), tested.folder / "sample.png")
    if tested.envelopes:
        points = [(each.pressure, tested.curves[each.member.name].strength) for each in tested.done]
        line = {s.quantity: s.mean for s in tested.statistics if not s.group}
        leave(plot_envelope(title, points, line["friction_angle"], line["cohesion"]), tested.folder / "envelope.png")


FOUND = "# found by dembound material:"
"""Begin of the comments above the strengths that are written."""


def match_strengths(
    path: Path,
    case: DiskCase,
    targets: Mapping[str, float],
    settings: list[str] | None,
    seeds: int,
    output: Path,
    loading: LoadingOptions,
) -> None:
    """Find pb_ten and pb_coh with which samples of a case have strengths (Pa) by test, and write the case with them.

    path : of the case, whose comments are kept. settings : changes of its keys, as of --set.

    Raises CaseError for a ratio that parallel bonds do not reach, and if the file to write exists.
    """
    from dembound.casefile.edit import commented, edited
    from dembound.files import write_text
    from dembound.studies.laboratory import strengths

    wanted = cast("dict[TestName, float]", dict(targets))
    target = Path(f"{case.name}_strengths.toml")
    if target.exists():
        raise CaseError([f"{target}: exists already; rename or remove it"])

    def make(changed: DiskCase, test: TestName) -> Sample:
        sample = loading.sample(changed, test)
        err.print(f"{case.name}: {test}, {sample.in_words}")
        return sample

    options, search, done = loading.options(), strengths.Search.of(case.material, wanted), []
    said = f"{case.name}: stopped; the same command continues what is left"
    with ending_with(said), shown(case.name, "samples") as report:
        measure = strengths.measure_in(make, case, seeds, options, output / f"{case.name}_strengths", report)
        for trial in search.trials(measure):
            done.append(trial)
            for line in strengths.in_words(trial, wanted):
                out.print(f"{case.name}: {line}")
    best = search.best(done)
    keys = strengths.keys_of(case, best.pb_ten, best.pb_coh)
    tested = strengths.with_bonds(case, best.pb_ten, best.pb_coh)
    found = {test: strengths.strength_in_words(test, best) for test in wanted}
    comments = [f"{FOUND} {words}; {loading.sample(tested, test).in_words}" for test, words in found.items()]
    text = edited(text_for(target, path, case, settings), keys)
    write_text(target, commented(text, "material.pb_ten", comments, FOUND))
    print_written(target)
    if best.deviation(wanted) > strengths.CLOSE:
        missed = ", ".join(f"{test} is {strengths.excess_in_words(test, best, wanted)}" for test in wanted)
        said = f"no trial of {len(done)} is within {percent(strengths.CLOSE)}; written is the best one"
        err.print(f"{case.name}: {said}: {missed}")
        raise typer.Exit(FAILED)


def _ratio_of_samples(material: Material) -> float | None:
    """The ratio of compressive and tensile strength to expect of samples; None without both strengths of bonds."""
    from dembound.studies.laboratory.strengths import Search

    has_both = material.pb_ten is not None and material.pb_coh is not None
    return Search.of(material, {}).expected_ratio() if has_both else None


SEEDS = 8
"""Samples of each test, by default."""


@app.command("material", rich_help_panel=MORE)
@with_tables
def material(
    case: OneCase,
    *,
    ucs: Annotated[float | None, Option(min=0.0, help="Uniaxial compressive strength (Pa) to give samples.")] = None,
    tension: Annotated[
        float | None, Option(min=0.0, help="Tensile strength (Pa) to give them, by direct tension.")
    ] = None,
    seeds: Annotated[int, Option(min=1, callback=few, help="Samples of each test, for --ucs and --tension.")] = SEEDS,
    output: Output = Path("results"),
    changes: Settings = None,
    as_json: Annotated[bool, Option("--json", help="Print JSON, in SI units, for scripts.")] = False,
    loading: LoadingOptions,
) -> None:
    """Print what contacts and bonds make of the body, without a run.

    Elastic moduli, wave speeds by direction, and the stress of the first crack, by static solves of a brick.

    With --ucs or --tension samples are tested (`dembound test`), and a case is written that has these strengths.
    """
    if targets := {name: value for name, value in (("ucs", ucs), ("tension", tension)) if value}:
        if as_json:
            raise CaseError(["--json: is for the tables without a run, not allowed with --ucs or --tension"])
        match_strengths(case, load_disks(case, changes), targets, changes, seeds, output, loading)
        return
    if given := [*(["--seeds"] if seeds != SEEDS else []), *loading.given]:
        raise CaseError([f"{', '.join(given)}: for tests of samples, give --ucs or --tension"])
    from dembound.disks.scene import build
    from dembound.kinds.disks.micro_macro import describe_materials, material_rows, materials_of, packing_line

    scene = build(load_disks(case, changes))
    found = describe_materials(scene)
    for each, own in zip(found, materials_of(scene), strict=True):
        each["strength_ratio"] = _ratio_of_samples(own.material)
    if as_json:
        print_lines(*json.dumps(found, indent=2, allow_nan=False).splitlines())
        return
    for each, own in zip(found, materials_of(scene), strict=True):
        if own.layer:
            out.print(f"layer {own.layer}")
        out.print(packing_line(own.ground))
        for title, rows in material_rows(each):
            out.print()
            print_rows(title, rows)
        out.print()
        if each["strength_ratio"] is not None:
            what = f"pb_coh over pb_ten and pb_mcf = {own.material.pb_mcf:g}"
            out.print(f"Samples: compressive over tensile strength about {each['strength_ratio']:.2g}, from {what}")
            out.print()
