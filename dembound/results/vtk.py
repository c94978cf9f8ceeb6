"""Snapshots for ParaView: one VTU file each and a PVD file listing their times, or all in one VTKHDF file; a script.

The contents of the files are described in `disks.mesh`, `disks.contact_mesh` and `bar.mesh`, the format of the last one
in `results.vtkhdf`. Positions are in double precision, fields in single precision (`shown`), as the record has all
digits. Nothing is compressed: that would halve the files, but take longer than the steps of a short run.

Where bonds broke in the run, ``cracks.vtu`` has one vertex per broken bond, in the middle between its two disks at that
time:

| name | unit | shape | what |
|---|---|---|---|
| ``time`` | s | (k,) | when it broke, 0 in the static stage |
| ``mode`` | 1 | (k,) | how: 0 in tension, 1 in shear |
| ``particles`` | 1 | (k, 2) | ids of the two disks |
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from dembound.casefile.output import ParaView
from dembound.files import make_folder, replacing, replacing_by_name, write_text
from dembound.interrupts import look
from dembound.motion.kind import Kind
from dembound.motion.state import Arrays
from dembound.results.reader import cracks_until, datasets_in, open_record, snapshots_of, until
from dembound.results.vtkhdf import temporal_file

if TYPE_CHECKING:
    import h5py
    import meshio


def write_paraview(run: Path, folder: Path, kind: Kind[Any, Any], files: ParaView = "vtu") -> None:
    """Write every snapshot of a run for ParaView, nothing for a run without snapshots, or if `files` is none.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    folder
        created if it does not exist; receives ``particles_0000.vtu`` …, all with the digits of the last one, and
        ``particles.pvd``, or ``particles.vtkhdf``; ``view.py`` and, where bonds broke, ``cracks.vtu``; the same files
        for ``contacts`` if the record has them; for a bar ``bar_0000.vtu`` … in place of ``particles``.
    kind
        the kind of body that the run is of.
    files
        formats that are written.

    PVD files are written last, so all files they list exist.

    Raises CaseError when the record cannot be read, OSError or RecordError when a file cannot be written.
    """
    if files == "none":
        return
    with open_record(run) as file:
        snapshots = {_number_of(snapshot): snapshot for snapshot in snapshots_of(file)}
        if not snapshots:
            return
        digits = max(map(len, snapshots))
        make_folder(folder)
        particles = {name: dataset[:] for name, dataset in file["particles"].items()}
        particles |= {f"continuum/{name}": dataset[:] for name, dataset in file.get("continuum", {}).items()}
        cracks = cracks_until(file, np.inf)
        with ExitStack() as stack:
            series: dict[str, Callable[[str, float, meshio.Mesh], None]] = {}
            for number, snapshot in snapshots.items():
                look()
                time = float(snapshot.attrs["time"])
                fields = {name: dataset[:] for name, dataset in datasets_in(snapshot).items()}
                for name, mesh in kind.meshes(particles, fields, until(cracks, time)).items():
                    if name not in series:
                        series[name] = stack.enter_context(_series(folder, name, files))
                    series[name](number.zfill(digits), time, mesh)
        if len(cracks["time"]) > 0:
            _write(folder / "cracks.vtu", _cracks(cracks))
    write_text(folder / "view.py", kind.view_script)


def _number_of(snapshot: h5py.Group) -> str:
    """The number of a snapshot, as it is written in the record."""
    return str(snapshot.name).rsplit("/", maxsplit=1)[-1]


@contextmanager
def _series(folder: Path, name: str, files: ParaView) -> Iterator[Callable[[str, float, meshio.Mesh], None]]:
    """A function that writes one mesh of a series, given its number and time (s), as VTU or to the VTKHDF file.

    The PVD file is written at the end.
    """
    times: dict[str, float] = {}
    with temporal_file(folder / f"{name}.vtkhdf") if files != "vtu" else nullcontext() as all_in_one:

        def append(number: str, time: float, mesh: meshio.Mesh) -> None:
            if files != "vtkhdf":
                _write(folder / f"{name}_{number}.vtu", mesh)
                times[f"{name}_{number}.vtu"] = time
            if all_in_one is not None:
                all_in_one.append(time, mesh)

        yield append
    if files != "vtkhdf":
        _write_index(folder / f"{name}.pvd", times)


def _cracks(cracks: Arrays) -> meshio.Mesh:
    """Cracks as vertices with the point data of this module's table."""
    data = {"time": cracks["time"], "mode": cracks["shear"].astype(int), "particles": cracks["particles"]}
    return vertices(in_space(cracks["position"]), data)


def vertices(points: np.ndarray, data: Arrays) -> meshio.Mesh:
    """One vertex per point (n, 3) m, with arrays (n, …) on them."""
    import meshio  # imported here, as commands that write no files need not wait for it

    return meshio.Mesh(points, [("vertex", np.arange(len(points), dtype=np.int32)[:, None])], point_data=dict(data))


def shown(fields: Arrays) -> dict[str, np.ndarray]:
    """Fields by name in the precision for ParaView: single, whole numbers in 32 bits, truth values in 8."""
    kinds = {"f": np.float32, "i": np.int32, "b": np.uint8}
    return {name: values.astype(kinds[values.dtype.kind], copy=False) for name, values in fields.items()}


def _write(path: Path, mesh: meshio.Mesh) -> None:
    """Write a VTU file, either completely or not at all."""
    import meshio

    with replacing_by_name(path) as part:
        meshio.write(part, mesh, file_format="vtu", compression=None)


def in_space(vectors: np.ndarray, precision: type = np.float64) -> np.ndarray:
    """Vectors (n, 2) as (n, 3) with z = 0."""
    whole: np.ndarray = np.zeros((len(vectors), 3), precision)
    whole[:, :2] = vectors
    return whole


def _write_index(path: Path, times: dict[str, float]) -> None:
    """Write the PVD file: file name -> time in s."""
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    collection = ElementTree.SubElement(root, "Collection")
    for name, time in times.items():
        ElementTree.SubElement(collection, "DataSet", timestep=repr(time), part="0", file=name)
    ElementTree.indent(root)
    with replacing(path) as file:
        ElementTree.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)
