/* The keys of a model: the one place where each is declared. */
#include "system/model_keys.h"

#include "system/key_rows.h"

#define IN_MODEL(member) AT(struct model, member)
#define IN_KIND(member) AT(struct fiber_kind, member)

static const char *const scheme_words[] = {"paper", "kick-split", "drift-split", NULL};
static const char *const rule_words[] = {"srd", "at-a", "at+a", NULL};
static const char *const thermostat_words[] = {"none", "rescale", "maxwell-boltzmann", "rescale-layers", NULL};
static const char *const profile_words[] = {"uniform", "sine", "reverse", NULL};
static const char *const wall_words[] = {"no-slip", "slip", NULL};
static const char *const fill_words[] = {"planar", "paper", "none", NULL};
static const char *const bath_words[] = {"particles", "phantoms", NULL};
static const char *const medium_words[] = {"private", "pairs", "overdamped", NULL};
static const char *const draw_words[] = {"replace", "relax", "cayley", NULL};
static const char *const weight_words[] = {"hat", "quadratic", NULL};
static const char *const tensor_words[] = {"none", "oseen", "rpy", NULL};
static const char *const layout_words[] = {"mixed", "slab", NULL};
static const char *const exclusion_words[] = {"shared-vertex", "paper", NULL};
static const char *const crossing_words[] = {"sequential", "event-driven", NULL};
static const char *const rejection_words[] = {"stay", "bounce", NULL};
static const char *const frame_words[] = {"laboratory", "flow", NULL};
static const char *const size_words[] = {"end-to-end", "gyration", NULL};
static const char *const held_words[] = {"none", "first", "ends", NULL};
static const char *const start_words[] = {"equilibrium", "straight", "circle", NULL};

static const struct key solvent_keys[] = {
    {"per_cell", NUMBER_ABOVE(0, 10000), IN_MODEL(solvent.per_cell), UNIT("1/a0^3"), SYMBOL("gamma"), FIRST_FORMAT,
     TEXT("Mean number of particles per cell. Times the number of cells, rounded, it is the number of particles: 1 to "
          "2147483647.")},
    {"collision_interval", NUMBER_ABOVE(0, 10), IN_MODEL(solvent.collision_interval), UNIT("t0"), SYMBOL("dt_c"),
     FIRST_FORMAT,
     TEXT("Time between collisions: a whole multiple of `time_step` (to 1e-9 of it). Above 0.1 a warning: no liquid.")},
    {"rotation_angle", NUMBER_ABOVE(0, 180), IN_MODEL(solvent.rotation_angle), UNIT("degrees"), SYMBOL("alpha"),
     ABSENT("90"), FIRST_FORMAT,
     TEXT("90 takes the cheap path, without cosine and sine. Below 90 or above 170 a warning.")},
    {"rule", CHOICE(rule_words), IN_MODEL(solvent.rule), ABSENT("srd"),
     TEXT("What happens in a collision cell. `srd`: velocities relative to the cell's centre of mass are turned about "
          "a random axis. `at-a`: they are drawn anew from the Maxwell distribution, with the cell's momentum kept "
          "(Andersen thermostat without angular momentum; Noguchi et al. 2007). `at+a`: the same with the cell's "
          "angular momentum kept too. Both are thermostats by themselves, and `rotation_angle` has no meaning.")},
    {"thermostat", CHOICE(thermostat_words), IN_MODEL(solvent.thermostat), ABSENT("none"), FIRST_FORMAT,
     TEXT("`rescale`: one factor for all relative velocities, d(n-1) degrees of freedom per cell. `maxwell-boltzmann`: "
          "each cell's relative kinetic energy drawn from its canonical distribution (Huang et al. 2010). "
          "`rescale-layers`: as `rescale`, with a factor for each layer of cells along y (Tao et al. 2008).")},
    {"hydrodynamics", SWITCH, IN_MODEL(solvent.hydrodynamics), SYMBOL("HI"), ABSENT("true"), FIRST_FORMAT,
     TEXT("false: velocities of solvent particles are permuted at random after each collision, which keeps diffusion "
          "and friction but no hydrodynamic interactions.")},
    {"bath", CHOICE(bath_words), IN_MODEL(solvent.bath), ABSENT("particles"), FIRST_FORMAT,
     TEXT("`phantoms`: no solvent particles at all; at each collision the vertices of a cell collide with a "
          "Poisson(`per_cell`) number of velocities drawn anew, about `flow`. Needs `hydrodynamics: false`. See "
          "[below](#a-bath-of-phantoms).")},
    {"acceleration", VECTOR(-100, 100), IN_MODEL(solvent.acceleration), UNIT("a0/t0^2"), SYMBOL("f/m"),
     ABSENT("[0, 0, 0]"), FIRST_FORMAT,
     TEXT("Constant body force per mass on each solvent particle. A net force on the whole is a warning.")},
    {"profile", CHOICE(profile_words), IN_MODEL(solvent.profile), ABSENT("uniform"),
     TEXT("Where the acceleration acts. `uniform`: everywhere. `sine`: sin(2 pi y/L) of it at y (Kolmogorov flow). "
          "`reverse`: all of it below y = L/2, minus that above (two opposite Poiseuille flows).")},
};
static const struct key_table solvent_table = {"solvent", NULL, ROWS(solvent_keys)};

static const struct key second_keys[] = {
    {"share", NUMBER_ABOVE(0, 1), IN_MODEL(medium.second.share),
     TEXT("Of the particles that are of the second group: those with the highest numbers. Vertices are of the first.")},
    {"repulsion", NUMBER_ABOVE(0, 1000), IN_MODEL(medium.second.repulsion), UNIT("kT/a0"), SYMBOL("a_AB"),
     TEXT("Between members of the two groups, instead of `medium.repulsion`.")},
    {"start", CHOICE(layout_words), IN_MODEL(medium.second.start), ABSENT("mixed"),
     TEXT("Where the second group is laid. `mixed`: anywhere. `slab`: below `share` times the box's edge along y, the "
          "first group above.")},
};
static const struct key_table second_table = {"medium.second", NULL, ROWS(second_keys)};

static const struct key many_keys[] = {
    {"repulsion", NUMBER_ABOVE(0, 1000), IN_MODEL(medium.many.repulsion), UNIT("kT a0^2"), SYMBOL("B"),
     TEXT("B of the force B (rho_i + rho_j) (1 - r/range) between members, rho_i being the density about member i.")},
    {"range", NUMBER(0.1, 1), IN_MODEL(medium.many.range), UNIT("a0"), SYMBOL("r_d"), ABSENT("0.75"),
     TEXT("Range of the weight 15/(2 pi range^3) (1 - r/range)^2 of that density.")},
};
static const struct key_table many_table = {"medium.many_body", NULL, ROWS(many_keys)};

static const struct key medium_keys[] = {
    {"kind", CHOICE_FROM(MEDIUM_PRIVATE, medium_words), IN_MODEL(medium.kind),
     TEXT("With whom velocities mix, once in each time step. `private`: each vertex with a bath of its own (Langevin, "
          "Andersen), without solvent particles. `pairs`: any two members nearer than 1 a0, by the component of their "
          "relative velocity along the line between them; members are vertices and particles of mass 1 (Lowe-Andersen, "
          "Peters, Shardlow). `overdamped`: vertices have no velocities, and move by forces and noise (Ermak and "
          "McCammon 1978). See [media.md](media.md).")},
    {"rate", NUMBER_ABOVE(0, 1e6), IN_MODEL(medium.rate), UNIT("1/t0"), SYMBOL("Gamma"),
     TEXT("Rate at which a velocity is forgotten: that of a vertex, or the relative one of a pair at weight 1. The "
          "friction of a private bath, and of overdamped motion, is M times it; gamma of DPD is the reduced mass times "
          "it. With `draw: replace` at most 1/`time_step`.")},
    {"draw", CHOICE(draw_words), IN_MODEL(medium.draw), ABSENT("replace"),
     TEXT("`replace`: with the probability rate times dt the velocity is drawn anew (Andersen, Lowe-Andersen). "
          "`relax`: it keeps exp(-rate dt) of itself (Langevin, Peters). `cayley`: it keeps (1 - e)/(1 + e), e = rate "
          "dt/2 (Shardlow).")},
    {"weight", CHOICE(weight_words), IN_MODEL(medium.weight), ABSENT("hat"),
     TEXT(
         "Of pairs: how the rate depends on the distance r. `hat`: not at all below 1 a0. `quadratic`: as (1 - r)^2.")},
    {"density", NUMBER(0, 100), IN_MODEL(medium.density), UNIT("1/a0^3"), SYMBOL("rho"), OPTIONAL,
     TEXT("Of pairs: particles of mass 1 per volume. Times the volume, rounded, it is their number; with the vertices "
          "at most 16777216.")},
    {"tensor", CHOICE(tensor_words), IN_MODEL(medium.tensor), ABSENT("none"),
     TEXT("Of overdamped motion: how vertices of one fiber move each other through the fluid. `none`: not at all. "
          "`rpy`: as spheres that may overlap (Rotne, Prager, Yamakawa). `oseen`: as points, which stops with an error "
          "where vertices come so near that the tensor is not positive.")},
    {"radius", NUMBER(0, 100), IN_MODEL(medium.radius), UNIT("a0"), SYMBOL("a_h"), OPTIONAL,
     TEXT("Of overdamped motion with a tensor: hydrodynamic radius of a vertex. The viscosity is `rate` M/(6 pi "
          "radius).")},
    {"inextensible", SWITCH, IN_MODEL(medium.inextensible), ABSENT("false"),
     TEXT("Of overdamped motion: bonds keep `bond_length` by tension, and there is no noise (kT = 0). Springs have no "
          "effect then. See [media.md](media.md#filaments).")},
    {"repulsion", NUMBER(-1000, 1000), IN_MODEL(medium.repulsion), UNIT("kT/a0"), SYMBOL("a"), ABSENT("0"),
     TEXT("Of pairs: a of the force a (1 - r) between any two members nearer than 1 a0 (DPD). Below 0 an attraction, "
          "which needs `many_body`.")},
    {"second", SECTION(second_table), OPTIONAL, ONE_LINE, TEXT("A second group of particles; absent: none.")},
    {"many_body", SECTION(many_table), OPTIONAL, ONE_LINE,
     TEXT("A repulsion that grows with the density (Warren, Phys. Rev. E 68, 066702 (2003)); absent: none.")},
};
static const struct key_table medium_table = {"medium", NULL, ROWS(medium_keys)};

static const struct key place_keys[] = {
    {"center", VECTOR(-LATTICE_MAX_EDGE, LATTICE_MAX_EDGE), AT(struct fiber_place, center), UNIT("a0"), FIRST_FORMAT,
     TEXT("Middle of the straight fiber, or of the circle.")},
    {"direction", VECTOR(-1000, 1000), AT(struct fiber_place, direction), FIRST_FORMAT,
     TEXT("Along the straight fiber, or normal to the circle; any length but 0.")},
};
static const struct key_table place_table = {"fibers.places", "A list, one item per fiber that has a place of its own.",
                                             ROWS(place_keys)};

static const struct key fiber_keys[] = {
    {"name", NAME, IN_KIND(name), FIRST_FORMAT,
     TEXT("Names the kind in tables and trajectories; each kind has its own.")},
    {"count", WHOLE32(1, INT32_MAX), IN_KIND(count), SYMBOL("N_c"), FIRST_FORMAT,
     TEXT("Fibers of this kind. All kinds together have at most 2147483647 vertices.")},
    {"vertices", WHOLE32(1, INT32_MAX), IN_KIND(vertices), SYMBOL("N_v"), FIRST_FORMAT,
     TEXT("Vertices of each fiber; 1 is a free point, which needs no `bond_length` and no `spring`; a ring has 3 or "
          "more. The paper's L is `vertices` times `bond_length`.")},
    {"ring", SWITCH, IN_KIND(ring), ABSENT("false"), FIRST_FORMAT,
     TEXT("true: the last vertex is bonded to the first.")},
    {"frozen", SWITCH, IN_KIND(frozen), ABSENT("false"),
     TEXT("true: these fibers stand still. In collisions their vertices take part as those of other fibers do, with "
          "velocities of their own, which move nothing; a moving fiber meets them as if they were infinitely heavy.")},
    {"held", CHOICE(held_words), IN_KIND(held), ABSENT("none"),
     TEXT("Single vertices that stand still in the same way, while the rest of the fiber moves: the `first` one, or "
          "both `ends`, where they are at the start. See [contacts.md](contacts.md#fibers-that-stand-still).")},
    {"mass", NUMBER_ABOVE(0, 65536), IN_KIND(mass), UNIT("m"), SYMBOL("M"), FIRST_FORMAT,
     TEXT("Mass of a vertex, rounded to a multiple of 2^-16 m (1.5e-5), so that the mass of a cell is summed exactly. "
          "Should be about `per_cell`; a warning beyond a factor of 2.")},
    {"bond_length", NUMBER(0, 512), IN_KIND(bond_length), UNIT("a0"), SYMBOL("l0"), IDLE_WITH("vertices", "0"),
     FIRST_FORMAT,
     TEXT("Rest length of a bond, Eq. (1); 0 makes Gaussian springs. The *mean* length is larger (0.538 for 0.5 and "
          "spring 100) and must be below half the shortest edge of the box. Above 1 a warning.")},
    {"spring", NUMBER_ABOVE(0, 1e9), IN_KIND(spring), UNIT("kT/a0^2"), SYMBOL("K/l0"), IDLE_WITH("vertices", "1"),
     FIRST_FORMAT, TEXT("Spring constant of a bond, k in k/2 (R - l0)^2. The paper's K is this times `bond_length`.")},
    {"bending", NUMBER(0, MODEL_MOST_BENDING), IN_KIND(bending), UNIT("kT"), SYMBOL("kT l_p/l0"), ABSENT("0"),
     FIRST_FORMAT,
     TEXT("kappa in kappa (1 - cos theta), Eq. (2); 0: no bend forces. Give this or `persistence_length`.")},
    {"persistence_length", NUMBER(0, 1e9), IN_KIND(persistence_length), UNIT("a0"), SYMBOL("l_p"), EXCLUDES("bending"),
     OPTIONAL, DERIVES, TEXT("Sets `bending` to l_p/l0; needs a `bond_length` above 0.")},
    {"stands_for", WHOLE32(0, 1000000000), IN_KIND(stands_for), OPTIONAL, DERIVES,
     TEXT("Vertices of a finer Gaussian chain which this one stands for. `spring` is given of the finer chain then; "
          "that of this one follows, so that `keeps` stays. Needs `bond_length: 0`, open chains, no bending. See "
          "[media.md](media.md#effective-potentials).")},
    {"keeps", CHOICE(size_words), IN_KIND(keeps), ABSENT("end-to-end"), DERIVES,
     TEXT("With `stands_for`: what both chains have in common, the mean square of the `end-to-end` distance, or of the "
          "radius of `gyration`.")},
    {"diameter", NUMBER(0, 512), IN_KIND(diameter), UNIT("a0"), SYMBOL("D"), ABSENT("0"),
     TEXT("Diameter of the tube around each bond, with half spheres at its ends; 0: a thin line. From 0.0001 to the "
          "mean length of a bond. Needs `crossing: {rule: event-driven}` and two or more vertices; see "
          "[thick.md](thick.md).")},
    {"force", VECTOR(-1e6, 1e6), IN_KIND(force), UNIT("kT/a0"), SYMBOL("F"), ABSENT("[0, 0, 0]"), FIRST_FORMAT,
     TEXT("Constant force on each vertex. A net force on the whole is a warning.")},
    {"start", CHOICE_FROM(START_EQUILIBRIUM, start_words), IN_KIND(start), OPTIONAL, FIRST_FORMAT,
     TEXT("`equilibrium`: exact sample of the phantom chain, open fibers only. `straight`: evenly spaced, open fibers "
          "only. `circle`: evenly spaced, rings only. If absent: equilibrium, for rings circle.")},
    {"places", LIST(place_table, struct fiber_place, offsetof(struct fiber_kind, placed)), IN_KIND(place), OPTIONAL,
     ONE_LINE,
     TEXT("Where the first fibers of the kind are laid (`straight` and `circle`); the rest is placed at random. At "
          "most `count`.")},
};
static const struct key_table fiber_table = {"fibers", "A list, one item per kind of fiber.", ROWS(fiber_keys)};

static const struct key wall_keys[] = {
    {"kind", CHOICE_FROM(WALL_NO_SLIP, wall_words), IN_MODEL(walls.kind),
     TEXT("What happens to a particle that hits a wall. `no-slip`: its velocity relative to the wall is reversed, and "
          "cells that the wall cuts hold virtual particles (`fill`). `slip`: only the velocity's y component is "
          "reversed.")},
    {"fill", CHOICE(fill_words), IN_MODEL(walls.fill), ABSENT("planar"),
     TEXT("Virtual particles of a cell that a no-slip wall cuts. `planar`: a Poisson number, as if the solvent went on "
          "beyond the wall. `paper`: `per_cell` less the members of the cell (Tao et al. 2008). `none`: none.")},
    {"lower", VECTOR(-100, 100), IN_MODEL(walls.lower), UNIT("a0/t0"), SYMBOL("v_w"), ABSENT("[0, 0, 0]"),
     TEXT("Velocity of the wall at y = 0, without y component. With a `period`, its amplitude.")},
    {"upper", VECTOR(-100, 100), IN_MODEL(walls.upper), UNIT("a0/t0"), SYMBOL("v_w"), ABSENT("[0, 0, 0]"),
     TEXT("The same of the wall at y = L.")},
    {"shear_rate", NUMBER(-10, 10), IN_MODEL(walls.shear_rate), UNIT("1/t0"), EXCLUDES("lower"), OPTIONAL, DERIVES,
     TEXT("Applied shear rate: sets `lower` and `upper` to -1/2 and 1/2 of it times L, along x.")},
    {"strain", NUMBER(0, 1000), IN_MODEL(walls.strain), EXCLUDES("shear_rate"), OPTIONAL, DERIVES,
     TEXT("Amplitude of an oscillating strain: sets `shear_rate` to 2 pi/`period` of it.")},
    {"period", NUMBER(0, 1e6), IN_MODEL(walls.period), UNIT("t0"), ABSENT("0"),
     TEXT("Period of the walls' motion, cos(2 pi t/period): a whole number of collision intervals, 4 or more. 0: they "
          "move at a constant velocity.")},
};
static const struct key_table wall_table = {"walls", NULL, ROWS(wall_keys)};

static const struct key dumbbell_keys[] = {
    {"spring", NUMBER_ABOVE(0, 1e6), IN_MODEL(dumbbells.spring), UNIT("kT/a0^2"), SYMBOL("K"),
     TEXT("Constant K of the spring between the two particles of a dumbbell: the energy is K r^2/2 at a distance r.")},
    {"fraction", NUMBER_ABOVE(0, 1), IN_MODEL(dumbbells.fraction), ABSENT("1"),
     TEXT("Share of the solvent's particles that are in dumbbells; the others are independent.")},
    {"depth", NUMBER(0, 100), IN_MODEL(dumbbells.depth), UNIT("kT"), ABSENT("0"),
     TEXT("Between walls: the centers of dumbbells are attracted by each wall, with the energy -`depth` at the wall "
          "that rises to 0 in a straight line (2 c_2 of Tao et al. 2008).")},
    {"range", NUMBER_ABOVE(0, 100), IN_MODEL(dumbbells.range), ABSENT("1.2"),
     TEXT("Reach of this attraction, in units of sqrt(kT/K) (c_1).")},
};
static const struct key_table dumbbell_table = {"dumbbells", NULL, ROWS(dumbbell_keys)};

static const struct key drive_keys[] = {
    {"force", VECTOR(-1e6, 1e6), IN_MODEL(bead.drive.force), UNIT("kT/a0"), SYMBOL("F"), OPTIONAL,
     TEXT("Constant force on the bead. If absent: none.")},
    {"spring", NUMBER(0, 1e6), IN_MODEL(bead.drive.spring), UNIT("kT/a0^2"), SYMBOL("k"), OPTIONAL,
     TEXT("Constant k of a harmonic trap, k x^2/2 per component, whose middle is at `center` at the start. If absent: "
          "no trap.")},
    {"velocity", VECTOR(-100, 100), IN_MODEL(bead.drive.velocity), UNIT("a0/t0"), OPTIONAL,
     TEXT("Constant velocity of the trap. If absent: it stands.")},
    {"amplitude", VECTOR(-1024, 1024), IN_MODEL(bead.drive.amplitude), UNIT("a0"), OPTIONAL,
     TEXT("Amplitude of an oscillation of the trap, sin(2 pi t/period). If absent: none.")},
    {"period", NUMBER(0, 1e9), IN_MODEL(bead.drive.period), UNIT("t0"), OPTIONAL,
     TEXT("Period of this oscillation, at least 8 time steps.")},
};
static const struct key_table drive_table = {"bead.drive", NULL, ROWS(drive_keys)};

static const struct key bead_keys[] = {
    {"radius", NUMBER(1.5, 512), IN_MODEL(bead.radius), UNIT("a0"), SYMBOL("R"),
     TEXT("Radius R. Smaller ones are not resolved by the cells. The box has edges of at least 2 R + 4 and 40 "
          "collision intervals.")},
    {"mass", NUMBER(0, 1e12), IN_MODEL(bead.mass), UNIT("m"), SYMBOL("M"), OPTIONAL,
     TEXT("Mass, at least that of the solvent it displaces. If absent: that.")},
    {"center", VECTOR(-LATTICE_MAX_EDGE, LATTICE_MAX_EDGE), IN_MODEL(bead.center), UNIT("a0"), ABSENT("[0, 0, 0]"),
     TEXT("Where its center is at the start.")},
    {"drive", SECTION(drive_table), OPTIONAL, TEXT("What pulls it; absent: nothing.")},
};
static const struct key_table bead_table = {"bead", NULL, ROWS(bead_keys)};

static const struct key shear_keys[] = {
    {"rate", NUMBER(-10, 10), IN_MODEL(shear.rate), UNIT("1/t0"), OPTIONAL,
     TEXT("Shear rate dv_x/dy. With a `period`, its amplitude.")},
    {"strain", NUMBER(0, 1000), IN_MODEL(shear.strain), EXCLUDES("rate"), OPTIONAL, DERIVES,
     TEXT("Amplitude of an oscillating strain: sets `rate` to 2 pi/`period` of it.")},
    {"period", NUMBER(0, 1e6), IN_MODEL(shear.period), UNIT("t0"), OPTIONAL,
     TEXT("Period of the rate, cos(2 pi t/period): a whole number of collision intervals, 4 or more. 0: the rate is "
          "constant.")},
};
static const struct key_table shear_table = {"shear", NULL, ROWS(shear_keys)};

static const struct key crossing_keys[] = {
    {"forbidden", SWITCH, IN_MODEL(crossing.forbidden), ABSENT("true"), FIRST_FORMAT,
     TEXT("false: fibers pass through each other.")},
    {"rule", CHOICE_FROM(CROSSING_SEQUENTIAL, crossing_words), IN_MODEL(crossing.rule), ABSENT("sequential"),
     FALLBACK("event-driven"),
     TEXT("How bonds are kept from crossing. sequential: one vertex moves at a time, and a move that would cross a "
          "bond is rejected (the paper). event-driven: all vertices move at once, and bonds exchange momentum at the "
          "time when they touch.")},
    {"exclusion", CHOICE(exclusion_words), IN_MODEL(crossing.exclusion), ABSENT("shared-vertex"), FIRST_FORMAT,
     TEXT("Bonds that a moving bond is not tested against: those that share a vertex with it, or, as the paper "
          "literally says, all that are linked to either of the two moving bonds.")},
    {"refusal", CHOICE(rejection_words), IN_MODEL(crossing.rejection), ABSENT("stay"), FIRST_FORMAT,
     TEXT("What a vertex does whose move would cross a bond, after the exchange of momentum. stay: it stays where it "
          "is (the paper). bounce: it finishes the step with its new velocity if that crosses nothing; less heat "
          "([accuracy.md](accuracy.md#what-a-rejected-move-costs)).")},
    {"frame", CHOICE(frame_words), IN_MODEL(crossing.frame), ABSENT("laboratory"), FIRST_FORMAT,
     TEXT("The frame in which moves are made. laboratory: rejected vertices stand, and so lag behind a flow (the "
          "paper). flow: they go with the scene's `flow`; no lag.")},
};
static const struct key_table crossing_table = {"crossing", NULL, ROWS(crossing_keys)};

static const struct key top_keys[] = {
    {"box", CELLS(1, LATTICE_MAX_EDGE), IN_MODEL(box.cells), UNIT("a0"), SYMBOL("L_b"), FIRST_FORMAT,
     TEXT("Edge lengths of the periodic box, in whole collision cells. Edges may differ.")},
    {"time_step", NUMBER_ABOVE(0, 1), IN_MODEL(time_step), UNIT("t0"), SYMBOL("dt"), FIRST_FORMAT,
     TEXT("Step of the fibers' motion. `omega dt >= 2` for the fastest vibration of a fiber is an error, above 0.5 a "
          "warning.")},
    {"seed", WHOLE64(0, UINT64_MAX), IN_MODEL(seed), ABSENT("1"), ASIDE,
     TEXT("Key of every random number, all 64 bits of it; `--seed` says otherwise. With a `snapshot` the key is made "
          "of the seed and the snapshot ([conventions.md](conventions.md#streams)).")},
    {"order", CHOICE(scheme_words), IN_MODEL(scheme), ABSENT("kick-split"), FIRST_FORMAT,
     TEXT("Where the collision stands between drift and kick: see `src/step.c` and docs/accuracy.md. `paper` is the "
          "paper's list, literally.")},
    {"flow", VECTOR(-MODEL_MOST_FLOW, MODEL_MOST_FLOW), IN_MODEL(flow), UNIT("a0/t0"), SYMBOL("v_flow"),
     ABSENT("[0, 0, 0]"), FIRST_FORMAT,
     TEXT("Uniform velocity given to everything at the start. The total momentum is 0 but for it. A `snapshot` is "
          "given nothing: it must flow so already.")},
    {"dimensions", WHOLE32(2, 3), IN_MODEL(dimensions), SYMBOL("d"), ABSENT("3"),
     TEXT("2: everything moves in the plane of x and y. The box is then one cell thick, and fibers pass through each "
          "other.")},
    {"solvent", SECTION(solvent_table), OPTIONAL, TEXT("The SRD solvent; absent: none, and no collisions.")},
    {"medium", SECTION(medium_table), OPTIONAL, TEXT("A bath instead of an SRD solvent; absent: none.")},
    {"dumbbells", SECTION(dumbbell_table), OPTIONAL,
     TEXT("Pairs of solvent particles with a harmonic spring (Tao, Goetze and Gompper 2008); absent: none.")},
    {"bead", SECTION(bead_table), OPTIONAL,
     TEXT("A sphere in the solvent, on which particles do not slip ([bead.md](bead.md)); absent: none.")},
    {"walls", SECTION(wall_table), OPTIONAL, TEXT("Walls at y = 0 and y = L; absent: none.")},
    {"shear", SECTION(shear_table), OPTIONAL,
     TEXT("A shear of the box, by images that slide along x (Lees and Edwards 1972); absent: none.")},
    {"fibers", LIST(fiber_table, struct fiber_kind, offsetof(struct model, kinds)), IN_MODEL(kind), OPTIONAL,
     TEXT("Kinds of fibers, each with keys of its own; absent: none.")},
    {"crossing", SECTION(crossing_table), OPTIONAL, TEXT("May fibers cross?")},
};
const struct key_table model_keys = {"", NULL, ROWS(top_keys)};

const char *model_start_word(enum fiber_start start)
{
  return start_words[start - START_EQUILIBRIUM];
}
