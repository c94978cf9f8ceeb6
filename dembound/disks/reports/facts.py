"""Facts about a case of disks, in words."""

import numpy as np

from dembound.boundaries.words import side_in_words
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.monitor import FREE_FIELD
from dembound.casefile.messages import counted
from dembound.disks.contacts.layout import fill
from dembound.disks.loads import forces_of
from dembound.disks.reports.continuum_facts import continuum_facts
from dembound.disks.reports.incident_facts import incident_facts
from dembound.disks.reports.summary import describe_packing, describe_side
from dembound.disks.reports.wave_warnings import particles_per_wavelength, strong_waves
from dembound.disks.scene import DiskScene

BALANCED = 1e-9
"""Part of the forces of a pressure below which their sum is a rounding error."""


def disk_facts(scene: DiskScene) -> dict[str, str]:
    """Facts about a packing, its law and what acts on it."""
    case = scene.case
    facts = {"particles": _particles(scene), "contacts": f"{len(scene.assembly.pairs):,}"}
    if not scene.layout.is_plain:
        facts["rows of copies"] = f"{100.0 * fill(scene.layout):.0f} % of the lanes hold particles"
    facts |= _packing_facts(scene) | _law_facts(scene) | _hole_facts(case) | _static_facts(case)
    if scene.outside is not None:
        facts |= continuum_facts(scene)
    if scene.ground_waves is not None:
        facts |= incident_facts(scene)
    for side in scene.edges:
        facts[f"{side} side"] = _side_fact(scene, side)
    facts |= _load_facts(scene)
    facts |= _monitor_facts(scene)
    facts |= _tension_facts(scene)
    for name, count in particles_per_wavelength(scene).items():
        few = f"{count:.0f} particles per" if count >= 1.0 else "less than one particle per"
        facts[f"wave {name}"] = f"{few} shortest wavelength"
    return facts


def _monitor_facts(scene: DiskScene) -> dict[str, str]:
    """The particle of each monitor or that it is in the continuum, its place, and its twin in the free-field column."""
    facts, places = {}, scene.monitored
    for name in (monitor.name for monitor in scene.case.monitor):
        what = "in the continuum" if name in scene.between else f"particle {scene.monitors[name]}"
        x, y = places[name]
        twin = scene.monitors.get(f"{name}{FREE_FIELD}")
        column = "the ground without the body" if scene.seam is None else f"in the free-field column {twin}"
        beside = "" if twin is None else f", {column}"
        facts[f"monitor {name}"] = f"{what} at ({x:.3f}, {y:.3f}) m{beside}"
    return facts


def _tension_facts(scene: DiskScene) -> dict[str, str]:
    """Waves that would open contacts, for a run in which the law then changes."""
    if not (scene.has_history and scene.case.material.elastic_start):
        return {}
    law = scene.case.material.law
    return {
        f"stress of {name}": f"ρcv = {stress}; in tension contacts open, and the law changes to {law}"
        for name, stress in strong_waves(scene).items()
    }


def _particles(scene: DiskScene) -> str:
    """Number of particles, also before an excavation."""
    loose = scene.assembly.loose
    before = f", {scene.before.count:,} before the excavation" if scene.before is not None else ""
    severed = f"; {counted(loose, 'severed disk')} left out" if loose else ""
    return f"{scene.disk_count:,}{before}{severed}"


def _hole_facts(case: DiskCase) -> dict[str, str]:
    """Shape of every hole, and the stage in which it is made."""
    stages = {"before": "present from the start", "after": "excavated once the body has settled"}
    return {f"hole {hole.name}": f"{hole.type}, {stages[hole.stage]}" for hole in case.hole}


def _packing_facts(scene: DiskScene) -> dict[str, str]:
    packing = describe_packing(scene)
    speeds = [
        f"{name} = {packing[key]:.1f} m/s"
        for name, key in (("c_p", "p_wave_speed"), ("c_s", "s_wave_speed"))
        if packing[key] is not None
    ]
    stiffness = ", ".join(f"{name} {packing[name] / 1e9:.4f}" for name in ("C11", "C22", "C12", "C66"))
    return {
        "brick": f"{counted(packing['disks_per_brick'], 'disk')}, solid fraction {packing['solid_fraction']:.4f}, "
        f"{packing['coordination']:.3f} contacts per disk",
        "brick equilibrium": f"residual force ratio {packing['residual_ratio']:.1e}, "
        f"packed under {scene.ground.packed_pressure / 1e6:.3f} MPa",
        "homogenised stiffness": f"{stiffness} GPa",
        "wave speeds": ", ".join(speeds) or "no motion is free",
    }


def _law_facts(scene: DiskScene) -> dict[str, str]:
    """The law, and the limits of contacts and bonds."""
    material = scene.case.material
    if not scene.has_history:
        return {"law": f"{material.law}: contacts neither open nor slip, bonds do not break"}
    start = ", elastic until a contact opens, slips or closes or a bond yields" if material.elastic_start else ""
    bonds = "no bonds"
    if scene.ground.moduli.pb_emod > 0.0:
        tension, shear = (
            "unbreakable" if strength is None else f"{strength / 1e6:.3g} MPa"
            for strength in (material.pb_ten, material.pb_coh)
        )
        pressed = f" + σ·tan {material.pb_fa:g}°" if material.pb_fa > 0.0 else ""
        bonds = f"bonds {tension} in tension, {shear}{pressed} in shear"
    facts = {
        "law": f"{material.law}{start}",
        "strength": f"{bonds}; contacts slip at {material.fric:g} of their normal force",
    }
    if scene.ground.moduli.emod > 0.0:
        facts["tension"] = (
            f"in tension the stiffness falls to {100.0 * scene.ground.bond_share:.0f} %, as contacts open and only "
            "bonds carry; confine the contacts (static.stress) or lower material.contact_share"
        )
    if material.locked_in is not None:
        shares = [
            f"{100.0 * material.locked_in / strength:.3g} % of {key}"
            for key, strength in (("pb_ten", material.pb_ten), ("pb_coh", material.pb_coh))
            if strength is not None
        ]
        facts["locked-in stress"] = ", ".join([f"{material.locked_in / 1e6:.3g} MPa before the static stage", *shares])
    return facts


def _static_facts(case: DiskCase) -> dict[str, str]:
    """Loads and supports of the static stage."""
    static = case.static
    if static is None:
        return {}
    acting = [load.name for load in case.load if load.wave is None]
    if static.stress is not None:
        acting.append("σ_xx, σ_yy, σ_xy = {:.3g}, {:.3g}, {:.3g} MPa".format(*(s / 1e6 for s in static.stress)))
    if case.material.locked_in:
        acting.append("the locked-in stress")
    sides = ", ".join(f"{side} {table.type}" for side, table in static.boundary.items()) or "all free"
    return {
        "static stage": f"under {' and '.join(acting)}, to a force ratio of {static.ratio:g}",
        "static sides": sides,
    }


def _load_facts(scene: DiskScene) -> dict[str, str]:
    """What each load acts on, its whole force, and its time factor."""
    facts = {}
    for load in scene.case.load:
        nodes, forces = forces_of(load, scene)
        what = "particle" if nodes[0] < scene.disk_count else "node"
        on = counted(len(nodes), what) + (" of the continuum" if what == "node" else "")
        factor = "steady" if load.wave is None else f"times wave {load.wave}"
        whole = f"{_whole_of(load, scene, forces)} on {on}, {factor}"
        facts[f"load {load.name}"] = f"{whole}{_images(scene, nodes, forces)}"
    return facts


def _images(scene: DiskScene, nodes: np.ndarray, forces: np.ndarray) -> str:
    """What forces (k, 3) on nodes (k,) that are all beside a plane of symmetry are together with their images."""
    for side, edge in scene.edges.items():
        if scene.case.side(side).is_mirror and np.isin(nodes, edge.nodes).all():
            both = 2.0 * forces[:, :2].sum(axis=0) * (np.arange(2) != edge.axis)
            return "; with the images beyond {} ({:.4g}, {:.4g}) N/m".format(side, *both)
    return ""


def _whole_of(load: Load, scene: DiskScene, forces: np.ndarray) -> str:
    """The force of a load on all its nodes, or its pressure with the length of wall that makes forces (k, 3)."""
    whole = forces[:, :2].sum(axis=0)
    if load.pressure is None:
        return "({:.4g}, {:.4g}) N/m".format(*whole)
    all_forces = np.hypot(*forces[:, :2].T).sum()
    whole[np.abs(whole) < BALANCED * all_forces] = 0.0
    left = ", ({:.4g}, {:.4g}) N/m in all".format(*whole) if whole.any() else ""
    length = all_forces / abs(load.pressure)
    return f"{load.pressure / 1e6:.4g} MPa on {length:.4g} m of wall of hole {load.hole}{left},"


def _side_fact(scene: DiskScene, side: str) -> str:
    facts = describe_side(scene, side)
    return (
        f"{side_in_words(facts)}; {facts['particles']} particles, "
        f"D = {facts['diameter_min']:.3f}…{facts['diameter_max']:.3f} m, ΣD/H = {facts['diameter_sum_ratio']:.4f}"
    )
