"""Forms in which frames are printed. A form is a row of FORMATS: functions give text, piece by piece."""
import collections
import math

from .frames import SOLVENT, Kind
from .view import name, real, reals

# --- extended XYZ, for OVITO and ASE -----------------------------------------------------------------------------------

# Programs that read XYZ want chemical symbols; these stand for the kinds of fiber, one after the other.
SYMBOLS = ("C", "N", "O", "F", "P", "S", "B", "Si", "Cl", "Se")


def symbol(species):
    return SYMBOLS[max(species, 0) % len(SYMBOLS)]


def xyz(v):
    file, f = v.file, v.frame
    kinds = " ".join(("H" if text == SOLVENT else symbol(k)) + ":" + name(text)
                     for k, text in enumerate(file.names) if v.solvent or text != SOLVENT)
    yield (f"{len(v.shown)}\nLattice=\"{reals((f.edge[0], 0.0, 0.0, f.tilt, f.edge[1], 0.0, 0.0, 0.0, f.edge[2]))}\" "
           f"Properties=species:S:1:pos:R:3{':velo:R:3' if f.velocity else ''}:id:I:1:next:I:1:fiber:I:1:place:I:1 "
           f"pbc=\"{' '.join('FT'[p] for p in f.periodic)}\" Step={f.step} Time={real(f.time)} kinds=\"{kinds}\"\n")
    for row in v.shown:
        x, image = v.place(row)
        moves = " " + reals(v.velocity(row, image)) if f.velocity else ""
        following, fiber, along = (file.next[row], *v.fibers[row]) if row < file.particles else (-1, -1, -1)
        yield f"{'H' if file.is_solvent(row) else symbol(file.species[row])} {reals(x)}{moves} {row} {following} {fiber} {along}\n"


# --- LAMMPS data: https://docs.lammps.org/read_data.html, atom_style molecular; dump: https://docs.lammps.org/dump.html, custom -----
# Data hold one frame with bonds and angles, a dump all frames; types and numbers are the same, so that programs read both
# together. Coordinates are always in the cell, with the images that unwrap them. Numbers count from 1.

MOST_TYPES = 4097  # kinds of a model, and the solvent


def species_of(v, row):
    """The solvent of a checkpoint has no row of its own in the structure."""
    if row < v.file.particles and v.file.species[row] >= 0:
        return min(v.file.species[row], MOST_TYPES)  # which is one too many
    return max((k for k, text in enumerate(v.file.names) if text == SOLVENT), default=len(v.file.names))


def kind_of(v, species):
    """Of a kind in the file's scene, else zeros."""
    return v.file.kinds[species] if v.file.kinds and 0 <= species < len(v.file.kinds) else Kind(0.0, 0.0, 0.0)


def masses(v):
    """{species: mass} of what is printed; ValueError if rows of one have several, or one that LAMMPS does not take."""
    found = {}
    for row in v.shown:
        species, mass = species_of(v, row), v.file.mass[row] if row < v.file.particles else 1.0
        if not (mass > 0.0 and math.isfinite(mass) and found.setdefault(species, mass) == mass):
            raise ValueError(f"species {species}: LAMMPS data have one mass for each, which is above 0; these are not")
    return found


def allows(v):
    """ValueError if the file cannot have this form."""
    for row in range(v.file.rows):
        if species_of(v, row) >= MOST_TYPES:
            raise ValueError(f"the species of row {row} is above {MOST_TYPES - 1}, the last that LAMMPS data may have here")
    masses(v)


def atom(v, row):
    """Number, molecule, type, place, images; and the last."""
    x, image = v.place(row)
    molecule = 0 if v.file.is_solvent(row) else v.fibers[row][0] + 1
    return f"{v.number[row] + 1} {molecule} {species_of(v, row) + 1} {reals(x)} {' '.join('%.0f' % n for n in image)}", image


def data(v):
    file, f, mass = v.file, v.frame, masses(v)
    named = [k + 1 for k, text in enumerate(file.names) if text != SOLVENT]
    types = max([0, *named, *(species_of(v, row) + 1 for row in v.shown)])
    bonds = [row for row in v.shown if v.has_bond(row)]
    angles = [row for row in bonds if v.previous.get(row) in v.number and kind_of(v, file.species[row]).bending > 0.0]
    yield (f"# uncross: step {f.step}, time {real(f.time)} t0; units lj, atom_style molecular, boundary "
           f"{' '.join('fp'[p] for p in f.periodic)}\n\n{len(v.shown)} atoms\n{len(bonds)} bonds\n{len(angles)} angles\n"
           f"{types} atom types\n{types if bonds else 0} bond types\n{types if angles else 0} angle types\n\n")
    yield from (f"0 {real(edge)} {axis}lo {axis}hi\n" for edge, axis in zip(f.edge, "xyz"))
    yield f"{real(f.tilt)} 0 0 xy xz yz\n" if f.leans else ""
    yield "\nMasses\n\n"
    for k in range(types):
        yield f"{k + 1} {real(mass.get(k, 1.0))}{' # ' + name(file.names[k]) if k < len(file.names) else ''}\n"
    # Eq. (1) is k/2 (l - l0)^2, theirs is K (r - r0)^2; Eq. (2) is kappa (1 - cos theta) with theta = 0 where a fiber is
    # straight, theirs is K (1 + cos theta) with theta = 180 degrees there.
    if bonds and file.kinds is not None:
        yield "\nBond Coeffs # harmonic\n\n"
        yield from (f"{k + 1} {reals((0.5 * kind_of(v, k).spring, kind_of(v, k).bond_length))}\n" for k in range(types))
    if angles:
        yield "\nAngle Coeffs # cosine\n\n"
        yield from (f"{k + 1} {real(kind_of(v, k).bending)}\n" for k in range(types))
    yield "\nAtoms # molecular\n\n"
    yield from (atom(v, row)[0] + "\n" for row in v.shown)
    if f.velocity:
        yield "\nVelocities\n\n"
        yield from (f"{v.number[row] + 1} {reals(v.velocity(row, v.place(row)[1]))}\n" for row in v.shown)
    for title, rows, ends in (("Bonds", bonds, lambda row: (row, file.next[row])),
                              ("Angles", angles, lambda row: (v.previous[row], row, file.next[row]))):
        yield f"\n{title}\n\n" if rows else ""
        for k, row in enumerate(rows):
            yield f"{k + 1} {species_of(v, row) + 1} {' '.join(str(v.number[end] + 1) for end in ends(row))}\n"


def dump(v):
    """Of a cell that leans the bounds are those of the box around it."""
    f = v.frame
    yield (f"ITEM: TIMESTEP\n{f.step}\nITEM: NUMBER OF ATOMS\n{len(v.shown)}\nITEM: BOX BOUNDS{' xy xz yz' if f.leans else ''} "
           f"{' '.join('pp' if p else 'ff' for p in f.periodic)}\n")
    for edge, tilt in zip(f.edge, (f.tilt, 0.0, 0.0)):
        bounds = (min(0.0, tilt), edge + max(0.0, tilt), tilt)
        yield reals(bounds if f.leans else bounds[:2]) + "\n"
    yield f"ITEM: ATOMS id mol type x y z ix iy iz{' vx vy vz' if f.velocity else ''}\n"
    for row in v.shown:
        text, image = atom(v, row)
        yield f"{text} {reals(v.velocity(row, image))}\n" if f.velocity else text + "\n"


# --- VTF, for VMD: https://github.com/olenz/vtfplugin/wiki/VTF-format. Atoms and bonds once, then coordinates. ------------------

SOLVENT_RADIUS = 0.1  # a0, as shown
VERTEX_RADIUS = 0.25  # a0: a_h of the paper's Table II
DEGREES = 57.295779513082321  # in a radian


def cell(f):
    """Lengths of the edges; and the angles between them, where they are not right ones."""
    edges = (f.edge[0], abs(complex(f.tilt, f.edge[1])), f.edge[2])
    angles = " " + reals((90.0, 90.0, DEGREES * math.atan2(f.edge[1], f.tilt))) if f.leans else ""
    return f"unitcell {reals(edges)}{angles}\n"


def structure(v):
    file = v.file
    yield cell(v.frame)
    for row in v.shown:
        solvent, kind = file.is_solvent(row), file.species[row] if row < file.particles else -1
        called = SOLVENT if solvent else file.names[kind] if 0 <= kind < len(file.names) else "vertex"
        yield (f"atom {v.number[row]} radius {SOLVENT_RADIUS if solvent else VERTEX_RADIUS} name {name(called)} type "
               f"{0 if solvent else kind + 1} resid {0 if solvent else v.fibers[row][0] + 1} mass "
               f"{real(file.mass[row] if row < file.particles else 1.0)}\n")
    yield from (f"bond {v.number[row]}:{v.number[file.next[row]]}\n" for row in range(file.particles) if v.has_bond(row))


def coordinates(v):
    yield f"\ntimestep ordered\n# step {v.frame.step} time {real(v.frame.time)}\n{cell(v.frame)}"
    yield from (reals(v.place(row)[0]) + "\n" for row in v.shown)


# ------------------------------------------------------------------------------------------------------------------------

# one: only the last of the frames that are chosen; folds: coordinates are in the cell, asked for or not.
Format = collections.namedtuple("Format", "title one folds allows begin frame")
FORMATS = {"xyz": Format("extended XYZ", False, False, None, None, xyz),
           "lammps": Format("LAMMPS data", True, True, allows, None, data),
           "lammps-dump": Format("a LAMMPS dump", False, True, None, None, dump),
           "vtf": Format("VTF", False, False, None, structure, coordinates)}
