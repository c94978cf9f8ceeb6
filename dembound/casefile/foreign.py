"""Names of keys in other codes (PFC, UDEC, FLAC, Yade, LAMMPS) and in textbooks, and what to write here instead."""

import re
from collections.abc import Collection

_EMOD = "write emod, Pa: the normal stiffness of a contact is k_n = emod, N/m for each metre of thickness"
_PB_EMOD = "write pb_emod, Pa: a bond has pb_kn = pb_emod/(R1 + R2), Pa/m"
_SPEED = "write p_wave_speed, which with density gives the moduli: ρ c_p² along the rows of a square lattice"
_WIDTHS = "write radius, the mean one, and radius_ratio, the largest over the smallest"
_RATIO = "there is none for disks: it follows from kratio and pb_kratio, and `dembound check` prints c_p and c_s"
_BAR_RATIO = "there is none: a bar moves along its axis only, at the speed √(E/ρ)"
_DASHPOTS = "there is none: sides of type viscous absorb, damp takes energy from the whole body"
_DAMP = "write damp, which is for bringing bodies to rest: for waves leave it 0"
_BAR_DAMP = "write attenuation, 1/m: a wave fades by exp(−αx)"
_OUTSIDE_OF = "give [[load]] an acceleration, such as [0.0, -9.81] m/s², and [static] to settle under it"

Advice = tuple[tuple[str, str], ...]
"""What to write, for each key that a table may have; the first of them that it has decides, "" is for all others."""

_MODULUS: Advice = (
    ("youngs_modulus", "write youngs_modulus, Pa"),
    ("young_modulus", "write young_modulus, Pa"),
    ("emod", f"{_SPEED}; or write emod and pb_emod, Pa"),
    ("", "give [material] a p_wave_speed, or emod and pb_emod; [bar] youngs_modulus"),
)
_OF_SHEAR: Advice = (
    ("youngs_modulus", _BAR_RATIO),
    ("kratio", "there is none: it follows from kratio and pb_kratio, normal over shear stiffness, and from fric > 0"),
)
_DENSITY: Advice = (("density", "write density, kg/m³, of the body as a whole: a particle's is larger, by the pores"),)
_POISSON: Advice = (
    ("young_modulus", "write poisson_ratio"),
    ("youngs_modulus", _BAR_RATIO),
    ("", _RATIO),
)
_LOCAL: Advice = (
    ("attenuation", _BAR_DAMP),
    ("damp", _DAMP),
    ("beta_p", "write beta_p and beta_s, factors of ρc"),
    ("", "[material] has damp, for waves 0; [static] a damp of its own; [bar] attenuation"),
)
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
_RADII: Advice = (("radius", _WIDTHS), ("diameter", "write diameter, m"), ("", f"in [packing], {_WIDTHS}"))
_STEP: Advice = (("time_step", "write time_step, s"), ("", "[run] has time_step, s"))
_TIME: Advice = (("duration", "write duration, s"), ("", "[run] has duration, s"))
_STEPS: Advice = (
    ("duration", "write duration, s: `dembound check` prints the number of steps"),
    ("", "[run] has duration, s"),
)
_GRAVITY: Advice = (("", _OUTSIDE_OF),)
_POROSITY: Advice = (
    ("", "there is none: it follows from the packing's pattern; `dembound check` prints the solid fraction"),
)
_CENTRE: Advice = (("centre", "write centre, m"), ("position", "write position, m"), ("origin", "write origin, m"))
_PLACE: Advice = (("position", "write position = [x, y], m"), ("centre", "write centre = [x, y], m"))
_SCENE: Advice = (
    ("size", "write size = [width, height], m"),
    ("corners", "write corners = [x0, y0, x1, y1], m"),
    ("", "[packing] has size = [width, height], m, [bar] length"),
)

NAMES: dict[tuple[str, ...], Advice] = {
    ("kn", "k_n", "normal_stiffness", "stiffness"): (("emod", f"{_EMOD}; or p_wave_speed, which gives it"),),
    ("ks", "k_s", "shear_stiffness"): (("kratio", "write kratio = kn/ks; contacts have it with fric > 0 only"),),
    ("pb_kn", "pbkn"): (("pb_emod", f"{_PB_EMOD}; or p_wave_speed, which gives it"),),
    ("pb_ks", "pbks"): (("pb_kratio", "write pb_kratio = pb_kn/pb_ks"),),
    ("pb_deform", "deform", "deformability", "pb_modulus"): (("emod", "write emod, kratio, pb_emod and pb_kratio"),),
    (
        "young",
        "youngs",
        "e",
        "e_mod",
        "ym",
        "youngs_modulus",
        "young_modulus",
        "youngmodulus",
        "elastic_modulus",
    ): _MODULUS,
    ("modulus", "stiff", "emod", "e_modulus"): _MODULUS,
    ("shear_modulus", "shear", "g_modulus", "mu_lame"): _OF_SHEAR,
    ("bulk_modulus", "bulk", "k_modulus", "lame", "lambda"): _OF_SHEAR,
    ("poisson", "poissons_ratio", "poisson_ratio", "nu", "pr", "poissonratio"): _POISSON,
    ("porosity", "void_ratio", "solid_fraction", "poros"): _POROSITY,
    ("damping", "local_damping", "damp", "damp_local", "alpha", "damping_ratio", "numerical_damping"): _LOCAL,
    ("rayleigh", "rayleigh_damping", "beta", "quality_factor", "q_factor"): _LOCAL,
    ("dp_nratio", "dp_sratio", "dp_mode", "dashpot", "critical_damping", "restitution", "cn", "cs_damp"): (
        ("", _DASHPOTS),
    ),
    ("rho", "dens", "mass_density", "ball_density", "grain_density", "particle_density", "unit_weight"): _DENSITY,
    ("friction", "mu", "fric_coef", "friction_coefficient", "frictioncoefficient"): _FRICTION,
    ("friction_angle", "phi", "frictionangle", "fric_angle", "pb_phi", "fa"): _ANGLE,
    ("cohesion", "coh", "pb_cohesion", "pb_shear_strength", "shear_strength", "cb_shearf", "cb_shears"): _COHESION,
    ("ten", "tension", "tensile_strength", "pb_tension", "pb_tensile_strength", "cb_tenf", "cb_tens"): _STRENGTH,
    ("rmul", "pb_radius", "pb_rad", "radius_multiplier"): (("pb_rmul", "write pb_rmul, bond over smaller radius"),),
    ("vp", "v_p", "cp", "c_p", "pwave", "p_speed", "p_velocity", "velocity_p"): _P_SPEED,
    ("vs", "v_s", "cs", "c_s", "swave", "s_speed", "s_velocity", "velocity_s"): _S_SPEED,
    ("rmin", "r_min", "rmax", "r_max", "rlo", "rhi", "radius_min", "radius_max", "min_radius", "max_radius"): _RADII,
    ("diameter", "d50", "particle_size", "grain_size", "ball_radius"): _RADII,
    ("dt", "delta_t", "time_increment", "deltat"): _STEP,
    ("time", "end_time", "t_end", "tend", "total_time", "tmax", "solve_time", "duration_s"): _TIME,
    ("steps", "nsteps", "n_steps", "cycle", "cycles", "cyc", "iterations"): _STEPS,
    ("gravity", "grav", "body_force"): _GRAVITY,
    ("center", "origin", "centroid"): _CENTRE,
    ("pos", "location", "coordinates"): _PLACE,
    ("width", "height", "box", "domain", "extent"): _SCENE,
    ("freq", "f0", "fpeak", "omega"): (("frequency", "write frequency, Hz"), ("period", "write period, s")),
    ("amp", "peak", "ppv", "velocity", "pgv"): (
        ("amplitude", "write amplitude, m/s"),
        ("scale", "write scale"),
    ),
    ("units", "unit", "system"): (("", "there is none: all numbers are in SI units, m, s, kg, Pa"),),
    ("thickness", "depth", "out_of_plane"): (("", "there is none: a scene is 1 m thick, forces are N/m"),),
    ("plane_strain", "plane_stress"): (("", "there is none: disks are plane, ν follows from kratio and pb_kratio"),),
    ("sigma", "sxx", "syy", "sxy", "insitu", "initial_stress", "in_situ_stress", "confining"): (
        ("stress", "write stress = [sxx, syy, sxy], Pa, tension positive"),
        ("", "[static] has stress = [sxx, syy, sxy], Pa, tension positive"),
    ),
    ("horizon_length", "delta", "m_ratio"): (("horizon", "write horizon, in spacings: δ = horizon·Δx"),),
    ("dx", "mesh_size", "cell_size", "grid_spacing", "h_max"): (
        ("spacing", "write spacing, m"),
        ("element", "write element, m"),
    ),
    ("gc", "gf", "g_f", "g_c", "toughness", "energy_release_rate"): (
        ("fracture_energy", "write fracture_energy, J/m²"),
    ),
    ("pressure_amplitude", "p0", "load_pressure"): (("pressure", "write pressure, Pa"),),
}
"""Foreign names -> what to write."""

BY_NAME = {name: advice for names, advice in NAMES.items() for name in names}

VALUES = {
    ("quiet", "absorbing", "lysmer", "dashpot", "nonreflecting", "non_reflecting", "silent"): "viscous",
    ("freefield", "ff"): "free_field",
    ("pml", "cpml", "perfectly_matched_layer", "infinite", "infinite_element", "semi_infinite"): "outside",
    ("clamped", "pinned", "rigid", "wall"): "fixed",
    ("cyclic", "periodic_space"): "periodic",
    ("linear_parallel_bond", "parallel_bond", "pbond", "linearparallelbond", "parallelbond"): "linearpbond",
    ("linear", "hooke", "hookean"): "elastic",
    ("hexagonal", "square", "lattice", "cubic", "regular"): "A",
    ("random", "dense", "irregular"): "B",
    ("sine", "sin", "harmonic", "sinusoidal"): "sine_burst",
    ("cos", "hann", "hanning", "raised_cosine"): "cosine",
    ("mexican_hat",): "ricker",
    ("step", "heaviside", "ramp"): "constant",
    ("record", "table", "history", "accelerogram"): "file",
    ("fd", "fdm", "central_difference"): "finite_difference",
    ("pd", "bond_based"): "peridynamics",
}
"""Names of types in other codes -> the type here."""

TYPE_OF = {name: value for names, value in VALUES.items() for name in names}


def translated(name: str, keys: Collection[str]) -> str | None:
    """What to write for a foreign name, in words, in a table that may have these keys; None for an unknown name."""
    advice = BY_NAME.get(_plain(name), ())
    return next((text for key, text in advice if key == "" or key in keys), None)


def own_type(name: object, types: Collection[str]) -> str | None:
    """The type that a foreign name of a type stands for, if it is one of these."""
    found = TYPE_OF.get(_plain(name)) if isinstance(name, str) else None
    return found if found in types else None


def _plain(name: str) -> str:
    """A name in small letters, its parts joined by "_"."""
    return re.sub(r"[^a-z0-9]+", "_", name.lower().replace("'", "")).strip("_")
