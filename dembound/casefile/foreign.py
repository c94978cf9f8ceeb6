"""Names of keys in other codes (PFC, UDEC, FLAC, YADE, LAMMPS, SPECFEM) and textbooks, with the keys to use instead."""

import re
from collections.abc import Collection

from dembound.casefile.types import LAWS

_LAWS = " or ".join(f'"{name}"' for name in LAWS)
_MORE = "; see docs: start/from_pfc"
"""Reference to the page with more information, at the end of a line."""

_WATER = "; see docs: tasks/slopes"
"""Reference to the page that says what works instead."""

_EMOD = "write emod, Pa: the normal stiffness of a contact is k_n = emod, N/m for each metre of thickness"
_PB_EMOD = "write pb_emod, Pa: a bond has pb_kn = pb_emod/(R1 + R2), Pa/m"
_WIDTHS = "write radius, the mean one, and radius_ratio, the largest over the smallest"
_RATIO = (
    f"there is none for disks: it follows from kratio and pb_kratio, and `dembound check` prints c_p and c_s{_MORE}"
)
_BAR_RATIO = "there is none: a bar moves along its axis only, at the speed √(E/ρ)"
_DASHPOTS = f"is of contacts: dp_nratio and dp_sratio in [material]; sides of type viscous absorb waves{_MORE}"
_DAMP = f"write damp, which is for bringing bodies to rest: for waves leave it 0{_MORE}"
_BAR_DAMP = "write attenuation, 1/m: a wave fades by exp(−αx)"
_WEIGHT = f"give [[load]] an acceleration, such as [0.0, -9.81] m/s², and [static] to settle under it{_MORE}"
_IN_SITU = f"[static] has stress = [sxx, syy, sxy], Pa, tension positive: it replaces walls with a servo{_MORE}"
_DRY = f"there is none: the ground is dry, without a water table, pore pressure or flow{_WATER}"
_EMPTY = f"there is none: no water stands on the ground, a dam is empty{_WATER}"
_VELOCITY = "give wave_p (along the normal) or wave_s (across it) the name of a [wave.NAME]"

Advice = tuple[tuple[str, str], ...]
"""Advice by key of the table: the first key that the table allows is used, "" stands for all others."""

_MODULUS: Advice = (
    ("youngs_modulus", "write youngs_modulus, Pa"),
    ("young_modulus", "write young_modulus, Pa"),
    ("young", f"write young and poisson, of the body, or emod and pb_emod, of contacts and bonds, Pa{_MORE}"),
    ("", "give [material] a p_wave_speed, or emod and pb_emod; [bar] youngs_modulus"),
)
_OF_SHEAR: Advice = (("youngs_modulus", _BAR_RATIO), ("shear", f"write bulk and shear, Pa, of the body{_MORE}"))
_DENSITY: Advice = (("density", "write density, kg/m³, of the body as a whole: a particle's is larger, by the pores"),)
_POISSON: Advice = (
    ("young_modulus", "write poisson_ratio"),
    ("youngs_modulus", _BAR_RATIO),
    ("poisson", f"write poisson, and young, of the body{_MORE}"),
    ("", _RATIO),
)
_LOCAL: Advice = (
    ("attenuation", _BAR_DAMP),
    ("damp", _DAMP),
    ("beta_p", "write beta_p and beta_s, factors of ρc"),
    ("", f"[material] has damp, for waves 0; [static] a damp of its own; [bar] attenuation{_MORE}"),
)
_RAYLEIGH = 'write [damping] type = "rayleigh" and band, [material] quality_factor = 1/(2ξ); α and β follow from them'
_STRENGTH: Advice = (
    ("strength", "write strength, Pa"),
    ("pb_ten", 'write pb_ten, Pa, with law = "linearpbond"'),
    ("", "[material] has pb_ten and pb_coh, [bar] strength"),
)
_COHESION: Advice = (("pb_coh", 'write pb_coh, Pa, with law = "linearpbond"'), ("strength", "write strength, Pa"))
_FRICTION: Advice = (("fric", "write fric, the coefficient of contacts: tan φ, no angle; bonds have the angle pb_fa"),)
_ANGLE: Advice = (("pb_fa", "write pb_fa, degrees, for bonds; contacts have the coefficient fric = tan φ"),)
_P_SPEED: Advice = (
    ("p_wave_speed", "write p_wave_speed, m/s"),
    ("wave_speed", "write wave_speed, m/s"),
    ("", "[material] has p_wave_speed, [bar] wave_speed"),
)
_S_SPEED: Advice = (("s_wave_speed", "write s_wave_speed, m/s"), ("wave_speed", _BAR_RATIO))
_RADII: Advice = (
    ("radius_ratio", _WIDTHS),
    ("pattern", 'write radius: disks of pattern "A" are equal, those of "B" and "C" also have radius_ratio'),
    ("radius", "write radius, m"),
    ("diameter", "write diameter, m"),
    ("", f"in [packing], {_WIDTHS}"),
)
_STEP: Advice = (
    ("time_step", 'write time_step, s, or leave it out: "auto" is 0.9 of the stability limit'),
    ("", "[run] has time_step, s"),
)
_TIME: Advice = (("duration", "write duration, s"), ("", "[run] has duration, s"))
_STEPS: Advice = (
    ("duration", f"write duration, s: `dembound check` prints the number of steps{_MORE}"),
    ("max_steps", "write ratio, the force ratio at which the body is at rest, and max_steps"),
    ("", f"[run] has duration, s; [static] ratio and max_steps{_MORE}"),
)
_POROSITY: Advice = (
    ("", f"there is none: it follows from the packing's pattern; `dembound check` prints the solid fraction{_MORE}"),
)
_REST: Advice = (
    ("ratio", "write ratio, the mean unbalanced over the mean contact force at which the body is at rest"),
    ("", "[static] has ratio, the mean unbalanced over the mean contact force at which the body is at rest"),
)
_CENTRE: Advice = (("centre", "write centre, m"), ("position", "write position, m"), ("origin", "write origin, m"))
_PLACE: Advice = (("position", "write position = [x, y], m"), ("centre", "write centre = [x, y], m"))
_SCENE: Advice = (
    ("size", "write size = [width, height], m"),
    ("corners", "write corners = [x0, y0, x1, y1], m"),
    ("", "[packing] has size = [width, height], m, [bar] length"),
)

NAMES: dict[str, Advice] = {
    "kn k_n normal_stiffness stiffness ball_kn hooke_kn": (
        ("emod", f"{_EMOD}; or p_wave_speed, which gives it{_MORE}"),
        ("", f"in [material], {_EMOD}{_MORE}"),
    ),
    "ks k_s kt shear_stiffness tangential_stiffness": (
        ("kratio", f"write kratio = kn/ks; contacts have it with fric > 0 only{_MORE}"),
        ("", f"in [material], write kratio = kn/ks{_MORE}"),
    ),
    "kn_ks kn_over_ks stiffness_ratio k_ratio kratio_c": (("kratio", "write kratio, and pb_kratio"),),
    "emod_c e_c ec contact_modulus effective_modulus emod_star": (("emod", f"{_EMOD}{_MORE}"),),
    "pb_kn pbkn": (("pb_emod", f"{_PB_EMOD}; or p_wave_speed, which gives it{_MORE}"),),
    "pb_emod_c pb_e pb_ec pbe bond_modulus": (("pb_emod", f"{_PB_EMOD}{_MORE}"),),
    "pb_ks pbks": (("pb_kratio", f"write pb_kratio = pb_kn/pb_ks{_MORE}"),),
    "pb_deform deform deformability pb_deformability pb_modulus": (
        ("emod", f"write emod, kratio, pb_emod and pb_kratio{_MORE}"),
    ),
    "young youngs e e_mod ym youngs_modulus young_modulus youngmodulus elastic_modulus": _MODULUS,
    "modulus stiff emod e_modulus": _MODULUS,
    "shear_modulus shear g_modulus mu_lame": _OF_SHEAR,
    "bulk_modulus bulk k_modulus lame lambda": _OF_SHEAR,
    "poisson poissons_ratio poisson_ratio nu pr poissonratio": _POISSON,
    "porosity void_ratio solid_fraction poros packing_fraction": _POROSITY,
    "damping local_damping damp damp_local alpha damping_ratio numerical_damping": (
        ("alpha_n", "write alpha_n and alpha_s, factors of the springs; beta_p and beta_s, of the dashpots"),
        *_LOCAL,
    ),
    "rayleigh rayleigh_damping rayleigh_alpha rayleigh_beta xi": (
        ("mechanisms", _RAYLEIGH),
        ("quality_factor", _RAYLEIGH),
        *_LOCAL,
    ),
    "beta quality_factor q_factor qkappa qmu viscosity": _LOCAL,
    "dp_mode dashpot critical_damping restitution cn cs_damp": (
        ("dp_nratio", 'write dp_nratio and dp_sratio, shares of critical damping, with law = "linearpbond"'),
        ("", _DASHPOTS),
    ),
    "c_n c_s_dashpot impedance": (("beta_p", "write beta_p and beta_s, factors of ρc, or leave them out"),),
    "rho dens mass_density ball_density density_ball grain_density particle_density": _DENSITY,
    "mass unit_weight": _DENSITY,
    "friction mu fric_coef friction_coefficient frictioncoefficient xmu": _FRICTION,
    "friction_angle phi frictionangle fric_angle pb_phi fa": _ANGLE,
    "cohesion coh pb_cohesion pb_shear_strength shear_strength cb_shearf cb_shears": _COHESION,
    "ten tension tensile_strength pb_tension pb_tensile_strength cb_tenf cb_tens": _STRENGTH,
    "pb_strength bond_strength ucs tensilestrength": _STRENGTH,
    "rmul pb_radius pb_rad radius_multiplier bond_radius": (("pb_rmul", "write pb_rmul, bond over smaller radius"),),
    "mcf moment_contribution moment_contribution_factor lambda_m": (
        ("pb_mcf", "write pb_mcf, 0 to 1, the share of the moment in the stress of bonds"),
    ),
    "rgap reference_gap": (("law", f"there is none: contacts are unloaded at their packed distance{_MORE}"),),
    "rolling_friction rolling_resistance rfric etaroll eta_roll mu_roll mu_r rrlinear": (
        ("rr_fric", f"write rr_fric, the largest moment over R̄ times the normal force{_MORE}"),
    ),
    "model contact_model cmat bond_type contact_type cm_type": (
        ("law", f"write law, {_LAWS}"),
        ("material", f"[material] has law, {_LAWS}{_MORE}"),
    ),
    "contact contacts bond bonds property properties materials": (
        ("material", f"one [material] is for all contacts and bonds{_MORE}"),
    ),
    "vp v_p cp c_p pwave p_speed p_velocity velocity_p": _P_SPEED,
    "vs v_s cs c_s swave s_speed s_velocity velocity_s": _S_SPEED,
    "rmin r_min rmax r_max rlo rhi radius_min radius_max min_radius max_radius": _RADII,
    "diameter d50 particle_size grain_size ball_radius r rmean rrelfuzz": _RADII,
    "psd gradation distribution size_distribution": (
        ("pattern", f'radii are uniform between two limits: with pattern "B" or "C", {_WIDTHS}{_MORE}'),
    ),
    "n_balls num_balls number count n_particles ball_count nballs": (
        ("pattern", "there is none: it follows from size and radius; `dembound check` prints it"),
    ),
    "lattice arrangement cubic hexagonal": (("pattern", 'write pattern, "A" square, "B" or "C" random'),),
    "random_seed random rng": (("seed", "write seed"), ("pattern", 'pattern "B" or "C" has seed')),
    "ball balls particles disks brick pbrick geometry mesh": (
        ("material", f"[packing] has pattern, size and radius{_MORE}"),
    ),
    "periodic is_periodic": (("pattern", 'two opposite sides may have type = "periodic"'),),
    "gap installation_gap interaction_radius": (
        ("bond_gap", "write bond_gap, m: gaps up to it are bonded"),
        ("pattern", 'pattern "B" or "C" has bond_gap, m: gaps up to it are bonded'),
    ),
    "clump clumps rblock rblocks": (("material", f"there is none: particles are disks{_MORE}"),),
    (
        "water fluid groundwater water_table water_level water_density phreatic phreatic_line "
        "phreatic_surface pore pore_pressure pp saturation seepage permeability undrained"
    ): (("", _DRY),),
    "reservoir reservoir_level upstream_level tailwater": (("", _EMPTY),),
    "thermal temperature": (("", "there is none: the body has no temperature"),),
    "dfn joint joints fracture fractures smooth_joint crack cracks": (
        ("packing", "write [[joint]] with points, or with dip and spacing for a set; bonds break by law"),
    ),
    "sj_da jdilation dilation_angle": (("dilation", "write dilation, degrees"),),
    "zdilation": (("dilation_end", "write dilation_end, the slip at which dilation ends"),),
    "layers soil strata stratum zones": (("packing", "write [[layer]] for each, from the surface down"),),
    "dt delta_t time_increment deltat": _STEP,
    "courant cfl timestep_factor safety_factor": (("safety", "write safety, share of the stability limit"),),
    "mass_scaling density_scaling timestep_scale scaling": (
        ("", f"there is none: it would change the speed of waves{_MORE}"),
    ),
    "time end_time t_end tend t_max total_time tmax solve_time duration_s run_time": _TIME,
    "steps nsteps n_steps nstep cycle cycles cyc iterations solve solver": _STEPS,
    "ratio_average solve_ratio unbalanced_ratio unbalanced tolerance ratio_average_limit": _REST,
    "large_strain large_strain_on small_strain": (
        ("geometry", 'write geometry, "updated" or "reference"'),
        ("", '[material] has geometry, "updated" or "reference", with law = "linearpbond"'),
    ),
    "threads nthreads cores nproc": (("", "give the command: `dembound run CASE --threads 2`"),),
    "gravity grav body_force": (("", _WEIGHT),),
    "center origin centroid": _CENTRE,
    "pos location coordinates coords x y": _PLACE,
    "width height box domain extent": _SCENE,
    "freq f0 fpeak omega": (("frequency", "write frequency, Hz"), ("period", "write period, s")),
    "amp peak ppv velocity pgv": (
        ("amplitude", "write amplitude, m/s"),
        ("scale", "write scale"),
        ("wave_p", _VELOCITY),
        ("beta_p", f'with type = "viscous_input", {_VELOCITY}'),
    ),
    "vx vy xvel yvel velocity_x velocity_y velx vely wave input": (
        ("wave_p", _VELOCITY),
        ("beta_p", f'with type = "viscous_input", {_VELOCITY}'),
    ),
    "t0 tshift delay onset time_shift": (("start", "write start, s"),),
    "filename file table_file name_of_source_file": (
        ("path", "write path"),
        ("start", 'with type = "file", write path'),
    ),
    "source sources force forcesolution": (
        ("material", "[[load]] has a force and a position, or a side a wave; [wave.NAME] is its time factor"),
        ("method", "[[load]] has a pressure, or an end a wave; [wave.NAME] is its time factor"),
    ),
    "history histories hist measure measurement receiver receivers station stations": (
        ("", f"[[monitor]] has name and position, [output] stress and snapshots{_MORE}"),
    ),
    "interval output_interval nvar frequency_of_output": (
        ("history_interval", "write history_interval, s; snapshots is their number"),
    ),
    "component direction variable quantity": (("position", "there is none: all components are recorded"),),
    "vtk dump save movie": (("snapshots", "write snapshots, their number, and paraview"),),
    "excavation excavate tunnel null_zones": (
        ("stage", 'write stage = "after"'),
        ("", '[[hole]] has a shape and stage = "after"'),
    ),
    "walls facet facets floor plate": (
        ("material", f"[[wall]] has points and a velocity; [boundary.bottom] and other sides have a type{_MORE}"),
    ),
    "fix fixed fixity": (("beta_p", 'write type = "fixed" or "roller"'),),
    "quiet absorbing absorb pml free_field boundaries stacey apply": (
        ("type", 'write type = "viscous", "viscous_input", "free_field" or "outside"'),
        ("material", 'each side has a type: [boundary.left] type = "viscous", "free_field" or "outside"'),
        ("method", 'each end has a type: [boundary.left] type = "viscous" or "matched_layer"'),
    ),
    "units unit system": (("", "there is none: all numbers are in SI units, m, s, kg, Pa"),),
    "thickness depth out_of_plane": (("", "there is none: a scene is 1 m thick, forces are N/m"),),
    "plane_strain plane_stress": (("", "there is none: disks are plane, ν follows from kratio and pb_kratio"),),
    "sigma sxx syy sxy insitu in_situ initial_stress in_situ_stress target_stress": (
        ("max_steps", f"write stress = [sxx, syy, sxy], Pa, tension positive{_MORE}"),
        ("", _IN_SITU),
    ),
    "servo confining confinement sigma1 sigma3": (
        ("max_steps", f"write stress = [sxx, syy, sxy], Pa, tension positive{_MORE}"),
        ("", _IN_SITU),
    ),
    "k0 k_0 k_zero lateral_pressure": (
        ("max_steps", f"write k0, the stress along x over that along y due to weight{_MORE}"),
        ("", f"[static] has k0, the stress along x over that along y due to weight{_MORE}"),
    ),
    "stress traction sigma_n": (
        ("pressure", "write pressure, Pa, on the wall of a hole, or force, N/m"),
        ("amplitude", "write amplitude, m/s: a wave of stress σ has v = σ/(ρc)"),
        ("beta_p", "give wave_p or wave_s a wave of the incident velocity v = σ/(ρc), without a factor of 2"),
        ("", _IN_SITU),
    ),
    "horizon_length delta m_ratio": (("horizon", "write horizon, in spacings: δ = horizon·Δx"),),
    "dx spacing mesh_size cell_size grid_spacing h_max": (
        ("spacing", "write spacing, m"),
        ("element", "write element, m"),
        ("pattern", "write radius, half the distance of two disks of a square lattice"),
    ),
    "gc gf g_f g_c toughness energy_release_rate": (("fracture_energy", "write fracture_energy, J/m²"),),
    "pressure_amplitude p0 load_pressure": (("pressure", "write pressure, Pa"),),
}
"""Foreign names -> advice."""

BY_NAME = {name: advice for names, advice in NAMES.items() for name in names.split()}

VALUES = {
    "quiet absorbing lysmer dashpot nonreflecting non_reflecting silent": "viscous",
    "freefield ff": "free_field",
    "pml cpml perfectly_matched_layer infinite infinite_element semi_infinite": "outside",
    "clamped pinned rigid wall": "fixed",
    "cyclic periodic_space": "periodic",
    **{" ".join(law.elsewhere): name for name, law in LAWS.items() if law.elsewhere},
    "hexagonal square lattice cubic regular": "A",
    "random dense irregular": "B",
    "sine sin harmonic sinusoidal": "sine_burst",
    "cos hann hanning raised_cosine": "cosine",
    "mexican_hat": "ricker",
    "step heaviside ramp": "constant",
    "record table history accelerogram": "file",
    "fd fdm central_difference": "finite_difference",
    "pd bond_based": "peridynamics",
}
"""Names of types in other codes -> the type here."""

TYPE_OF = {name: value for names, value in VALUES.items() for name in names.split()}


def translated(name: str, keys: Collection[str]) -> str | None:
    """Advice for a foreign name, in words, in a table that may have these keys; None for an unknown name."""
    advice = BY_NAME.get(_plain(name), ())
    return next((text for key, text in advice if key == "" or key in keys), None)


def own_type(name: object, types: Collection[str]) -> str | None:
    """The type with a foreign name, if it is one of the allowed types."""
    found = TYPE_OF.get(_plain(name)) if isinstance(name, str) else None
    return found if found in types else None


def _plain(name: str) -> str:
    """A name in small letters, its parts joined by "_"."""
    return re.sub(r"[^a-z0-9]+", "_", name.lower().replace("'", "")).strip("_")
