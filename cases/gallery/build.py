"""Runs the examples of this folder, draws their pictures and writes their pages, docs/gallery.

python cases/gallery/build.py [--quick] [--pages] [NAME ...]

Without names all examples are run, with --quick those of `QUICK`; --pages writes the pages alone, with the figures of
the last runs, which measured.json holds. An example is a case file of this folder. Its first comment has what it shows
and, indented, the commands that run it and draw its picture, the last of which estimates its error; its title is that
of the page.
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Sequence
from contextlib import chdir
from dataclasses import asdict, dataclass
from pathlib import Path

os.environ.setdefault("MPLBACKEND", "Agg")

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from PIL import Image

import dembound
from dembound import shipped
from dembound.cli import app
from dembound.plot import chart, moving, scene, style
from dembound.words import percent

HERE = Path(__file__).parent
DOCS = HERE.parents[1] / "docs"
PAGES, MEASURED = DOCS / "gallery", HERE / "measured.json"

TOPICS = {
    "Waves along a bar of disks": ("p_pulse", "p_and_s", "packings"),
    "What artificial sides return": ("calibration", "beta_sweep", "sides", "side_reflection", "error_chart"),
    "Ground under waves from below": ("free_field", "earthquake", "resonance", "tunnel", "two_tunnels"),
    "Waves at an angle, and surfaces": ("oblique_sv", "canyon", "canyon_p", "canyon_sv", "slope", "rayleigh"),
    "Slopes and dams under waves from below": ("step_sv", "landslide_quake", "empty_dam"),
    "Sources and exact solutions": ("point_source", "lamb", "blast", "blast_cracks"),
    "Weight, stress and contacts": ("excavation", "in_situ_stress", "force_chains", "sliding", "collapse"),
    "Joints, blocks and piles": ("joint_waves", "newmark", "toppling", "pile"),
    "Bars: waves": ("dispersion", "interface", "matched_layer", "measured_pulse", "hopkinson"),
    "Bars: cracks": ("spalling", "fracture_energy"),
}
"""Topic of the index -> names of its examples."""

QUICK = ("p_pulse", "resonance", "interface")
"""Examples that tests run."""

DRAWING = ("plot", "signals", "sweep", "chart", "boundary", "packing")
"""Commands whose pictures are shown."""

WIDTH, DOTS = 6.2, 125
"""Width of a picture in inches, and its dots per inch: ten points are legible on a page of 390 and of 1440 pixels."""

SCENE = (4.4, 4.2)
"""Largest width and height of a scene in a picture, inches."""

CHART = (WIDTH, 6.4)
"""Width and height of an error chart, inches."""

HEIGHTS = (3.3, 5.8)
"""Least and largest height of a figure of a picture, inches."""

PANEL = 1.9
"""Height for each of many panels below each other, inches, which may make a figure higher."""

RUNS = ("build", "settle", "step", "record")
"""Sections of the entry `seconds` of a summary that are the time of a run, without imports, compiling and pictures."""

SHADES = 8
"""Red, green and blue of a picture are rounded to multiples of this, which halves its file."""


@dataclass(frozen=True)
class Measured:
    """What the last run of an example gave: its time, what it computed, its predicted error, and what is drawn."""

    seconds: float
    size: str
    error: str
    drawn: str


@dataclass(frozen=True)
class Example:
    """A case of this folder: its text and commands, from its first comment, and its tables as TOML."""

    name: str
    text: str
    commands: tuple[str, ...]
    tables: str

    @classmethod
    def read(cls, name: str) -> Example:
        """The example of this name."""
        lines = (HERE / f"{name}.toml").read_text(encoding="utf-8").splitlines()
        end = next(number for number, line in enumerate(lines) if not line.startswith("#"))
        comment = [line.removeprefix("#").removeprefix(" ") for line in lines[:end]]
        commands = tuple(line.strip() for line in comment if line.startswith("  "))
        text = "\n".join(line for line in comment if line and not line.startswith("  "))
        return cls(name, text, commands, "\n".join(lines[end:]).strip())

    @property
    def title(self) -> str:
        """Title of the case."""
        return str(tomllib.loads(self.tables)["title"])

    @property
    def has_movie(self) -> bool:
        """Whether one of its commands writes a movie, to NAME.gif."""
        return any(command.startswith("dembound movie ") for command in self.commands)

    def page(self, measured: Measured) -> str:
        """The page of the example."""
        commands = "\n".join((f"dembound cases copy gallery/{self.name}", *self.commands[:-1]))
        error, *unknown = measured.error.split("; ")
        moving = f"![The same, moving](../pictures/gallery_{self.name}.gif)\n\n"
        return (
            f"# {self.title}\n\n{self.text}\n\n![{measured.drawn}](../pictures/gallery_{self.name}.png)\n\n"
            f"{moving if self.has_movie else ''}{measured.size}, {measured.seconds:.2g} s; "
            f"error: {error}{', not of all' if unknown else ''}.\n\n```sh\n{commands}\n```\n\n"
            f"```{{literalinclude}} ../../cases/gallery/{self.name}.toml\n"
            ":language: toml\n:start-at: title\n```\n"
        )


def index(examples: dict[str, Example], measured: dict[str, Measured]) -> str:
    """The page of all examples, cards by topic, and the list of pages."""
    parts = [
        "# Gallery\n\nEvery picture is a case that runs in seconds on one core, by the commands of its page. Errors "
        "are those of\n`dembound estimate results/NAME`, which names what it does not know (not of all).\n"
    ]
    for topic, names in TOPICS.items():
        parts.append(f"## {topic}\n\n::::{{grid}} 1 2 2 3\n:gutter: 3\n")
        for name in names:
            picture = f"[![{name}](../pictures/gallery_{name}.png)]({name}.md)"
            parts.append(f":::{{grid-item-card}}\n{picture}\n\n[{examples[name].title}]({name}.md)\n:::\n")
        parts.append("::::\n")
    parts.append("```{toctree}\n:hidden:\n:glob:\n\n*\n```\n")
    return "\n".join(parts)


def fitted(figure: Figure) -> np.ndarray:
    """The pixels (rows, columns, 3) of a figure in the common width, laid out again for it; a chart is scaled."""
    width, height = figure.get_size_inches()
    if figure.legends or figure.get_supylabel():
        rows = len({round(panel.get_position().y0, 2) for panel in figure.axes})
        most = max(HEIGHTS[1], PANEL * rows)
        figure.set_size_inches(WIDTH, float(np.clip(height * max(WIDTH / width, 0.75) + 0.4, HEIGHTS[0], most)))
        figure.suptitle(figure.get_suptitle(), fontsize=9)
    if figure.legends:
        figure.legends[0].remove()
        with rc_context({"legend.fontsize": 8, "legend.frameon": False}):
            style.outside_legend(figure, figure.axes, columns=3)
    style.set_pixels(figure, int(WIDTH * DOTS))
    return style.pixels_of(figure)


def execute(command: str, figures: list[Figure]) -> None:
    """Run a command in this process; its figures are kept instead of saved, if they are to be shown."""
    verb, *more = shlex.split(command)[1:]
    settings = ["--set", "output.pictures=false"] if verb in ("run", "sweep") else []
    saved, kept = style.save, figures if verb in DRAWING else []
    style.save = lambda figure, path, title=None: kept.append(figure)
    try:
        app([verb, *more, *settings], standalone_mode=False)
    finally:
        style.save = saved


def measure(example: Example) -> Measured:
    """Run all commands of an example in a new folder, and draw its picture."""
    figures: list[Figure] = []
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        shipped.copy(f"gallery/{example.name}", Path())
        for command in example.commands[:-1]:
            execute(command, figures)
        if example.has_movie:
            shutil.copy(f"{example.name}.gif", DOCS / "pictures" / f"gallery_{example.name}.gif")
        results = Path(example.commands[-1].removeprefix("dembound estimate "))
        error, summary = predicted(results), dembound.Results(results).summary
    pixels = np.rint(np.vstack([fitted(figure) for figure in figures]) / SHADES) * SHADES
    picture = Image.fromarray(np.minimum(pixels, 255).astype(np.uint8)).quantize(256, dither=Image.Dither.NONE)
    picture.save(DOCS / "pictures" / f"gallery_{example.name}.png", optimize=True)
    size = f"{summary['particles']:,} disks" if "particles" in summary else f"{summary['nodes']:,} nodes"
    seconds = sum(summary["seconds"][section] for section in RUNS)
    drawn = "; ".join(figure.get_suptitle().replace("\n", ", ") for figure in figures)
    return Measured(round(seconds, 2), f"{size}, {summary['steps']:,} steps", error, drawn)


def predicted(results: Path) -> str:
    """The largest error of a run that is predicted at any monitor, with its main cause, or why there is none."""
    try:
        budget = dembound.estimate(results)
    except dembound.CaseError as refused:
        return f"none: {refused.problems[0]}"
    worst, unknown = budget.worst(), budget.summary()["not_estimated"]
    if not worst.monitor:
        return f"none: {unknown[0]}"
    cause = max(worst.by, key=lambda name: worst.by[name], default="rounding")
    size = f"{percent(worst.share.value)}, at most {percent(worst.share.upper)}"
    words = f"{size}: {worst.quantity} at `{worst.monitor}`, most by {cause}"
    return "; ".join([words, *(f"not estimated: {each}" for each in unknown[:1])])


def read_measured() -> dict[str, Measured]:
    """Name of every example -> what its last run gave."""
    held = json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.exists() else {}
    return {name: Measured(**each) for name, each in held.items()}


def read_examples() -> dict[str, Example]:
    """Name of every example -> the example, by topic."""
    return {name: Example.read(name) for names in TOPICS.values() for name in names}


def main(arguments: Sequence[str]) -> None:
    """Run examples and write the pages."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--quick", action="store_true", help=f"run only {', '.join(QUICK)}")
    parser.add_argument("--pages", action="store_true", help="run nothing")
    asked = parser.parse_args(arguments)
    examples, measured = read_examples(), read_measured()
    chosen = [] if asked.pages else asked.names or (QUICK if asked.quick else list(examples))
    for name in chosen:
        measured[name] = measure(examples[name])
        ordered = {each: asdict(measured[each]) for each in examples if each in measured}
        MEASURED.write_text(json.dumps(ordered, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    for name in examples.keys() & measured.keys():
        (PAGES / f"{name}.md").write_text(examples[name].page(measured[name]), encoding="utf-8")
    if examples.keys() == measured.keys():
        (PAGES / "index.md").write_text(index(examples, measured), encoding="utf-8")


if __name__ == "__main__":
    scene.DRAWING = moving.DRAWING = SCENE
    chart.PAGE = CHART
    main(sys.argv[1:])
