"""What the columns of tables are called, and which of them share a panel: the only place where figures take labels from.

docs/observables.md says what each column means. A column or table that is not declared here is drawn all the same, under
its own name.
"""
import dataclasses
import re

T, A, E, P, V = "$t_0$", "$a_0$", "$kT$", r"$m\,a_0/t_0$", "$(a_0/t_0)$"
A2 = "$a_0^2$"
S = r"$(kT/a_0^3)$"


@dataclasses.dataclass(frozen=True)
class Column:
    name: str
    symbol: str = ""  # in mathematical text
    unit: str = ""  # 1 if empty

    @property
    def label(self):
        """For an axis: name, symbol and unit."""
        return " ".join(filter(None, (self.name, self.symbol, f"/ {self.unit}" if self.unit else "")))

    @property
    def short(self):
        """For a legend."""
        return ", ".join(filter(None, (self.name, self.symbol)))


COLUMNS = {
    "step": Column("step"),
    "time": Column("time", "$t$", T),
    # conserved
    "solvent_kinetic": Column("kinetic, solvent", r"$E_\mathrm{s}$", E),
    "vertex_kinetic": Column("kinetic, vertices", r"$E_\mathrm{v}$", E),
    "bond": Column("bonds", r"$E_\mathrm{bond}$", E),
    "bend": Column("bends", r"$E_\mathrm{bend}$", E),
    "pairs": Column("pairs", r"$E_\mathrm{pair}$", E),
    "total": Column("total energy", "$E$", E),
    "px": Column("momentum along x", "$P_x$", P),
    "py": Column("momentum along y", "$P_y$", P),
    "pz": Column("momentum along z", "$P_z$", P),
    # temperature
    "solvent": Column("solvent", r"$T_\mathrm{s}$", "$(kT/k_B)$"),
    "solvent_x": Column("solvent, x", "$T_x$", "$(kT/k_B)$"),
    "solvent_y": Column("solvent, y", "$T_y$", "$(kT/k_B)$"),
    "solvent_z": Column("solvent, z", "$T_z$", "$(kT/k_B)$"),
    "vertex": Column("vertices", r"$T_\mathrm{v}$", "$(kT/k_B)$"),
    "vertex_half_step": Column("vertices, half a step ahead", r"$T_\mathrm{v}^{+}$", "$(kT/k_B)$"),
    # collisions
    "moves": Column("moves of vertices"),
    "possible": Column("contacts found"),
    "executed": Column("contacts answered"),
    "negative": Column(r"with $\Delta P < 0$"),
    "softened": Column("softened rebounds"),
    "rigid": Column("rigid contacts"),
    "executed_per_possible": Column("answered per found"),
    "rate_per_vertex": Column("contacts per vertex and time", "", "$t_0^{-1}$"),
    "rate_over_theory": Column("rate over kinetic theory"),
    # statics
    "l": Column("bond length", r"$\langle l\rangle$", A),
    "l2": Column("bond length squared", r"$\langle l^2\rangle$", A2),
    "cos": Column("cosine of a bend", r"$\langle\cos\theta\rangle$"),
    "bond_energy": Column("energy per bond", "", E),
    "bend_energy": Column("energy per bend", "", E),
    "Ree2": Column("end-to-end distance squared", r"$\langle R^2\rangle$", A2),
    "Rg2": Column("radius of gyration squared", r"$\langle R_g^2\rangle$", A2),
    "lp": Column("persistence length", "$l_p$", A),
    "samples": Column("samples"),
    # dynamics
    "g": Column("all vertices", "$g(t)$", A2),
    "g_cm": Column("centres of mass", r"$g_\mathrm{cm}(t)$", A2),
    "g_middle": Column("middle vertices", r"$g_\mathrm{m}(t)$", A2),
    "d2": Column("middle vertex to nearest vertex", r"$\langle d^2\rangle(t)$", A2),
    "d2_contour": Column("middle vertex to contour", r"$\langle d^2\rangle_\mathrm{c}(t)$", A2),
    "d2_third": Column("middle third to contour", r"$\langle d^2\rangle_{1/3}(t)$", A2),
    "end_to_end": Column("end-to-end vector", r"$\langle R(t)\cdot R(0)\rangle/\langle R^2\rangle$"),
    "end_to_end_unit": Column("its direction", r"$\langle u(t)\cdot u(0)\rangle$"),
    "axis_unit": Column("direction of the regression axis", r"$\langle a(t)\cdot a(0)\rangle$"),
    "D": Column("diffusion coefficient", r"$D(t) = g_\mathrm{cm}/2dt$", r"$(a_0^2/t_0)$"),
    "g_cm_about_mean": Column("centres of mass, about their mean", r"$g_\mathrm{cm}'(t)$", A2),
    "D_about_mean": Column("about the mean displacement", r"$g_\mathrm{cm}'/2dt$", r"$(a_0^2/t_0)$"),
    "D_cumulative": Column("from t/2 to t", r"$(g_\mathrm{cm}(t) - g_\mathrm{cm}(t/2))/dt$", r"$(a_0^2/t_0)$"),
    "D_cumulative_about_mean": Column("from t/2 to t, about the mean", r"$(g_\mathrm{cm}'(t) - g_\mathrm{cm}'(t/2))/dt$",
                                      r"$(a_0^2/t_0)$"),
    "drift_x": Column("drift along x", "$v_x$", V),
    "drift_y": Column("drift along y", "$v_y$", V),
    "drift_z": Column("drift along z", "$v_z$", V),
    "intervals": Column("pairs of times compared"),
    # profile
    "y": Column("place across the flow", "$y$", A),
    "density": Column("density of the solvent", r"$\rho$", r"$(m/a_0^3)$"),
    "vx": Column("velocity along x", r"$\langle v_x\rangle$", V),
    "vy": Column("velocity along y", r"$\langle v_y\rangle$", V),
    "vz": Column("velocity along z", r"$\langle v_z\rangle$", V),
    "temperature": Column("temperature", "$T$", "$(kT/k_B)$"),
    "vx_in_phase": Column("in phase", r"$v_x^{\prime}$", V),
    "vx_out_of_phase": Column("out of phase", r"$v_x^{\prime\prime}$", V),
    # stress
    "sigma_xy": Column("bulk", r"$\sigma_{xy}$", S),
    "sigma_xy_kinetic": Column("bulk, kinetic", r"$\sigma_{xy}^\mathrm{kin}$", S),
    "sigma_xy_collisional": Column("bulk, collisional", r"$\sigma_{xy}^\mathrm{col}$", S),
    "sigma_lower": Column("lower wall", "", S),
    "sigma_upper": Column("upper wall", "", S),
    "N1": Column("first normal stress difference", "$N_1$", S),
    "pressure": Column("pressure", "$p$", S),
    "sigma_xy_spring": Column("bulk, springs", r"$\sigma_{xy}^\mathrm{spr}$", S),
    "N1_spring": Column("springs", r"$N_1^\mathrm{spr}$", S),
    "sigma_xy_fibers": Column("fibers", r"$\sigma_{xy}^\mathrm{fib}$", S),
    "N1_fibers": Column("fibers", r"$N_1^\mathrm{fib}$", S),
    "sigma_xy_contacts": Column("contacts", r"$\sigma_{xy}^\mathrm{con}$", S),
    "N1_contacts": Column("contacts", r"$N_1^\mathrm{con}$", S),
    # memory
    "vertices": Column("vertices", r"$\langle v(0)v(t)\rangle$", "(kT/m)"),
    "center": Column("centres of mass", r"$\langle V(0)V(t)\rangle$", "(kT/m)"),
    "stress_memory": Column("stress of a fiber", r"$\langle s(0)s(t)\rangle$", "(kT)²"),
    # pressure
    "p_xx": Column("along x", "$p_{xx}$", S),
    "p_yy": Column("along y", "$p_{yy}$", S),
    "p_zz": Column("along z", "$p_{zz}$", S),
    "p_xy": Column("off the diagonal", "$p_{xy}$", S),
    "potential": Column("potential energy", "$U$", "kT"),
    "force_square": Column("forces squared", r"$|\nabla U|^2$", "kT²/a0²"),
    "laplacian": Column("Laplacian", r"$\nabla^2 U$", "kT/a0²"),
    "configurational": Column("configurational", r"$T_\mathrm{conf}$", "kT"),
    "pressure_contacts": Column("of contacts", r"$p^\mathrm{con}$", S),
    # wake
    "distance": Column("distance from the bead's center", "$r$", A),
    "cosine": Column("cosine of the angle with the drive", r"$\cos\theta$"),
    "number": Column("vertices per volume", r"$\rho$", "$(a_0^{-3})$"),
    "along": Column("along the drive", r"$u_\parallel$", A),
    "away": Column("away from the axis", r"$u_\perp$", A),
    # topology
    "looked_at": Column("pairs of bonds looked at"),
    "crossed": Column("crossings"),
    "net": Column("net crossings"),
    "odd_pairs": Column("pairs that crossed an odd number of times"),
    "unsure": Column("pairs not decided"),
    "rate": Column("crossings per bond and time", "", r"$(1/t_0)$"),
    "first_time": Column("first crossing", "$t$", "$t_0$"),
    "last_time": Column("last crossing", "$t$", "$t_0$"),
    # orientation
    "RxRx": Column("along the flow", r"$\langle R_x R_x\rangle$", A2),
    "RyRy": Column("across the flow", r"$\langle R_y R_y\rangle$", A2),
    "RzRz": Column("along the vorticity", r"$\langle R_z R_z\rangle$", A2),
    "RxRy": Column("correlation", r"$\langle R_x R_y\rangle$", A2),
    "turning": Column("turning in the plane of flow", r"$\langle\dot\varphi\rangle$", r"$(1/t_0)$"),
    "uxux": Column("bonds along the flow", r"$\langle u_x u_x\rangle$"),
    "uyuy": Column("bonds across the flow", r"$\langle u_y u_y\rangle$"),
    "uzuz": Column("bonds along the vorticity", r"$\langle u_z u_z\rangle$"),
    "uxuy": Column("correlation of bonds", r"$\langle u_x u_y\rangle$"),
    "S": Column("nematic order", "$S$"),
    # bead
    "place_x": Column("place, x", "$x$", A),
    "place_y": Column("place, y", "$y$", A),
    "place_z": Column("place, z", "$z$", A),
    "velocity_x": Column("velocity, x", "$V_x$", V),
    "velocity_y": Column("velocity, y", "$V_y$", V),
    "velocity_z": Column("velocity, z", "$V_z$", V),
    "force_x": Column("force of the drive, x", "$F_x$", "$(kT/a_0)$"),
    "force_y": Column("force of the drive, y", "$F_y$", "$(kT/a_0)$"),
    "force_z": Column("force of the drive, z", "$F_z$", "$(kT/a_0)$"),
    "trap_x": Column("middle of the trap, x", "$c_x$", A),
    "trap_y": Column("middle of the trap, y", "$c_y$", A),
    "trap_z": Column("middle of the trap, z", "$c_z$", A),
    "work": Column("work of the drive", "$W$", E),
    "heat": Column("heat from its matter", "$Q$", E),
    "hits": Column("hits of particles"),
    # dumbbells
    "r2": Column("length squared", r"$\langle r^2\rangle$", A2),
    "rxrx": Column("along the flow", r"$\langle r_x r_x\rangle$", A2),
    "ryry": Column("across the flow", r"$\langle r_y r_y\rangle$", A2),
    "rzrz": Column("along the vorticity", r"$\langle r_z r_z\rangle$", A2),
    "rxry": Column("correlation", r"$\langle r_x r_y\rangle$", A2),
    "extension": Column("extension", "$R/R_0$"),
    "chi": Column("angle with the flow", r"$\chi$", "degrees"),
}


# Sums and counts since the start, and what drifts where a force acts: their mean over time says nothing.
RUNNING = {"total", "px", "py", "pz", "moves", "possible", "executed", "negative", "softened", "rigid",
           "executed_per_possible", "work", "heat", "hits", "place_x", "place_y", "place_z", "trap_x", "trap_y", "trap_z"}


@dataclasses.dataclass(frozen=True)
class Panel:
    """Columns over one x, with one y axis."""
    title: str
    columns: tuple
    y: str = ""  # label of the y axis; without it that of the first column
    log_x: bool = False
    log_y: bool = False
    change: bool = False  # since the first row
    level: float = None  # a line to compare with
    wide: bool = False


LAG = {"log_x": True}
PANELS = {
    "conserved": (
        Panel("Change of the total energy", ("total",), "$E(t) - E(0)$ / $kT$", change=True, level=0.0),
        Panel("Change of its parts", ("solvent_kinetic", "vertex_kinetic", "bond", "bend", "pairs"), "change since the start / $kT$",
              change=True),
        Panel("Total momentum", ("px", "py", "pz"), rf"momentum $P$ / ({P})"),
    ),
    "temperature": (
        Panel("Kinetic temperature", ("solvent", "vertex", "vertex_half_step"), "temperature $T$ / $(kT/k_B)$", level=1.0),
        Panel("Solvent by component", ("solvent_x", "solvent_y", "solvent_z"), "temperature $T$ / $(kT/k_B)$", level=1.0),
    ),
    "collisions": (
        Panel("Contacts since the start", ("possible", "executed", "negative", "softened", "rigid"), "number"),
        Panel("Moves since the start", ("moves",)),
        Panel("Contacts answered per contact found", ("executed_per_possible",)),
        Panel("Rate since the row before", ("rate_per_vertex",)),
        Panel("Rate over kinetic theory", ("rate_over_theory",), level=1.0),
    ),
    "bead": (
        Panel("Way since the start", ("place_x", "place_y", "place_z"), "way / $a_0$", change=True),
        Panel("Middle of the trap", ("trap_x", "trap_y", "trap_z"), "middle / $a_0$", change=True),
        Panel("Velocity", ("velocity_x", "velocity_y", "velocity_z"), f"velocity / {V}"),
        Panel("Force of the drive", ("force_x", "force_y", "force_z"), "force / $(kT/a_0)$"),
        Panel("Work and heat", ("work", "heat"), "energy / $kT$"),
        Panel("Hits since the start", ("hits",)),
    ),
    "wake": (
        Panel("Vertices around the bead, four directions", ("number",)),
        Panel("Their displacement from sample to sample", ("along", "away"), "displacement / $a_0$", level=0.0),
    ),
    "dynamics": (
        Panel("Mean square displacements", ("g", "g_cm", "g_cm_about_mean", "g_middle", "d2", "d2_contour"),
              "mean square displacement / $a_0^2$", log_y=True, wide=True, **LAG),
        Panel("Diffusion coefficient", ("D", "D_about_mean", "D_cumulative", "D_cumulative_about_mean"),
              r"diffusion coefficient $D$ / $(a_0^2/t_0)$", log_y=True, **LAG),
        Panel("Mean drift", ("drift_x", "drift_y", "drift_z"), r"mean displacement over $t$ / $(a_0/t_0)$", level=0.0, **LAG),
        Panel("Memory of the orientation", ("end_to_end", "end_to_end_unit", "axis_unit"), "correlation", **LAG),
        Panel("What stands behind each point", ("intervals",), log_y=True, **LAG),
    ),
    "profile": (
        Panel("Flow", ("vx",), f"velocity $v_x$ / {V}"),
        Panel("Velocities across the flow", ("vy", "vz"), f"velocity / {V}", level=0.0),
        Panel("First harmonic of the flow", ("vx_in_phase", "vx_out_of_phase"), f"amplitude / {V}"),
        Panel("Density", ("density",)),
        Panel("Temperature", ("temperature",), level=1.0),
        Panel("Samples", ("samples",)),
    ),
    "stress": (
        Panel("Shear stress", ("sigma_xy", "sigma_lower", "sigma_upper"), rf"stress $\sigma_{{xy}}$ / {S}"),
        Panel("Its parts in the bulk", ("sigma_xy_kinetic", "sigma_xy_collisional", "sigma_xy_spring", "sigma_xy_fibers", "sigma_xy_contacts"), rf"stress $\sigma_{{xy}}$ / {S}"),
        Panel("Normal stress difference", ("N1", "N1_spring", "N1_fibers", "N1_contacts"), level=0.0),
        Panel("Pressure", ("pressure",)),
    ),
    "pressure": (
        Panel("Pressure", ("pressure", "p_xx", "p_yy", "p_zz", "pressure_contacts"), rf"pressure / {S}"),
        Panel("Shear", ("p_xy",), level=0.0),
        Panel("Potential energy", ("potential",)),
        Panel("Configurational temperature", ("configurational",), level=1.0),
    ),
}
LAG_LABEL = "lag $t$ / $t_0$"
TITLES = {"conserved": "Energy and momentum", "temperature": "Temperature", "collisions": "Contacts of bonds",
          "statics": "Size and shape", "dynamics": "Motion", "profile": "Profile across the flow", "stress": "Stress",
          "dumbbells": "Shape of dumbbells", "orientation": "Orientation", "bead": "The bead", "wake": "The network around the bead", "topology": "Crossings of bonds",
          "pressure": "Pressure and configurational temperature", "memory": "Memory"}


def column(name):
    return COLUMNS.get(name, Column(name.replace("_", " ")))


def split(name):
    """('dynamics', 'rods') of the table dynamics-rods; the kind is empty where there is none."""
    match = re.fullmatch(r"(statics|dynamics)-(.*)", name)
    return match.groups() if match else (name, "")


def title(name):
    sort, kind = split(name)
    return TITLES.get(sort, name) + (f" of '{kind}'" if kind else "")


def panels(name, present):
    """The panels of a table with these columns (no errors, no x): those declared, and one for each other column."""
    declared = PANELS.get(split(name)[0], ())
    shown = [dataclasses.replace(p, columns=tuple(c for c in p.columns if c in present)) for p in declared]
    known = {c for p in declared for c in p.columns}
    lag = bool(declared) and declared[0].log_x
    others = [Panel(column(c).name, (c,), log_x=lag) for c in present if c not in known]
    return [p for p in shown if p.columns] + others
