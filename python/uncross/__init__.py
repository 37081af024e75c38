"""Noncrossing fibers and chains in a hydrodynamic solvent: libuncross for Python.

    import uncross
    run = uncross.Run("scene.yaml", seed=7, solvent={"per_cell": 10}).advance(1000)
    run.positions        # (vertices, 3) int64, lattice units: a view of the run's own memory
    run.velocities       # (vertices, 3) float64, a0/t0, half a step ahead: likewise
    run.tables["conserved"]["total"]

Units: a0 = kT = m = 1. Views cannot be written to; they change when the run is advanced, and keep it alive.
docs/library.md explains the library, docs/scene.md the keys of a scene.
"""
import operator
import os
import time

from ._library import ffi, lib, np

__all__ = ["BadInput", "Error", "FolderRun", "LATTICE_UNIT", "NoMemory", "NotWritten", "Run", "Scene", "Stopped",
           "version"]

LATTICE_UNIT = 2.0**-40  # a0
version = ffi.string(lib.uncross_version()).decode()


class Error(Exception):
    """What the library says went wrong. Attributes: code, and of a Stopped cause, step, entity, value, limit."""

    def __init__(self, message, error=None):
        super().__init__(message)
        for name in ("code", "cause", "step", "entity", "value", "limit"):
            setattr(self, name, getattr(error, name) if error is not None else 0)


class NoMemory(Error, MemoryError):
    """Memory is short."""


class BadInput(Error, ValueError):
    """A scene, a file or an argument is refused; nothing was written."""


class Stopped(Error, ArithmeticError):
    """The physics cannot go on."""


class NotWritten(Error):
    """A file or folder cannot be written."""


_ERRORS = {lib.UNCROSS_NO_MEMORY: NoMemory, lib.UNCROSS_BAD_INPUT: BadInput, lib.UNCROSS_STOPPED: Stopped,
           lib.UNCROSS_NOT_WRITTEN: NotWritten}


def _raise(error):
    message = ffi.string(error.message).decode(errors="replace")
    raise _ERRORS.get(error.code, Error)(message, error)


def _check(function, *arguments):
    """Calls a function whose last argument is the error: raises unless it returns a code of 0, or a handle."""
    error = ffi.new("uncross_error *")
    result = function(*arguments, error)
    if isinstance(result, int) and result != lib.UNCROSS_OK or not isinstance(result, int) and result == ffi.NULL:
        _raise(error)
    return result


def _whole(encoded):
    """A text for C, which ends at the first NUL: one that has any would be cut."""
    if b"\0" in encoded:
        raise BadInput(f"{encoded!r}: holds a NUL, which would end the text")
    return encoded


def _path(path):
    return _whole(os.fsencode(path))


def _utf8(text):
    return _whole(text.encode())


def _text_of(value):
    """A value as a setting takes it: a word, a number, a list."""
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_text_of(item) for item in value) + "]"
    if isinstance(value, (bool, np.bool_)):
        return str(bool(value)).lower()
    return repr(value.item() if isinstance(value, np.generic) else value) if not isinstance(value, str) else value


def _flatten(values, prefix=""):
    """("path", "value") of nested dictionaries, and of lists of them."""
    for key, value in values.items():
        if isinstance(value, (list, tuple)) and value and isinstance(value[0], dict):
            value = dict(enumerate(value))
        if isinstance(value, dict) and not value:
            yield prefix + str(key), "{}"  # a section that is there, as in a file
        elif isinstance(value, dict):
            yield from _flatten(value, f"{prefix}{key}.")
        else:
            yield prefix + str(key), _text_of(value)


def _settings(overrides):
    kept = [ffi.new("char[]", _utf8(f"{path}={value}")) for path, value in _flatten(overrides)]
    return ffi.new("char *[]", kept), len(kept), kept


class Scene:
    """What a run is of. Scene(path, **overrides), Scene.parse(text, **overrides), or Scene(dict).

    Overrides are keys of the scene; a dictionary changes single keys of a section: solvent={"per_cell": 10}. A path
    with dots works too: **{"fibers.0.count": 12}.
    """

    def __init__(self, source, **overrides):
        if isinstance(source, dict):
            self._take(_check(lib.uncross_scene_new))
            for path, value in (*_flatten(source), *_flatten(overrides)):
                _check(lib.uncross_scene_set, self._handle, _utf8(path), _utf8(value))
            _check(lib.uncross_scene_check, self._handle)
        else:
            texts, count, _kept = _settings(overrides)
            self._take(_check(lib.uncross_scene_read, _path(source), texts, count))

    @classmethod
    def parse(cls, text, name="scene", **overrides):
        """A scene from YAML; `name` stands for the file in messages."""
        texts, count, _kept = _settings(overrides)
        scene = cls.__new__(cls)
        scene._take(_check(lib.uncross_scene_parse, _path(name), _utf8(text), texts, count))
        return scene

    def _take(self, handle):
        """Ctrl-C is seen while a start is laid, which may take long: Python raises it in the callback, which then answers 0."""
        self._handle, self._raised = ffi.gc(handle, lib.uncross_scene_free), []
        self._watch = ffi.callback("uncross_start_watch", lambda _context: 1, error=0,
                                   onerror=lambda _kind, error, _trace: self._raised.append(error))
        _check(lib.uncross_scene_watch_start, self._handle, self._watch, ffi.NULL)

    def _start(self, function, *arguments):
        try:
            return _check(function, self._handle, *arguments)
        except BadInput:
            if self._raised:
                raise self._raised.pop() from None
            raise

    def _text(self, function, *arguments):
        text = ffi.gc(_check(function, self._handle, *arguments), lib.uncross_free)
        return ffi.string(text).decode()

    @property
    def text(self):
        """The effective scene as YAML, every default filled in."""
        return self._text(lib.uncross_scene_text)

    def get(self, path):
        """The text of one key of the effective scene, e.g. "solvent.per_cell"."""
        return self._text(lib.uncross_scene_get, _utf8(path))

    def number(self, path):
        """The number that one key of the effective scene holds."""
        value = ffi.new("double *")
        _check(lib.uncross_scene_number, self._handle, _utf8(path), value)
        return value[0]

    @property
    def warnings(self):
        """Sentences on the limits of the paper that the scene leaves. A run has those on its start, too."""
        return _told(lib.uncross_scene_warnings, self._handle)


def _told(function, handle):
    """The sentences that the library tells of a handle."""
    told = []
    tell = ffi.callback("void(void *, const char *)", lambda _context, text: told.append(ffi.string(text).decode()))
    _check(function, handle, tell, ffi.NULL)
    return told


def _scene(scene, overrides):
    if isinstance(scene, Scene):
        if overrides:
            raise TypeError("overrides go to the Scene, which is made already")
        return scene
    return Scene(scene, **overrides)


def _array(owner, pointer, *shape, dtype):
    """A view of the library's memory, which keeps `owner` alive and cannot be written to."""
    if 0 in shape:
        return np.empty(shape, dtype)
    alive = ffi.gc(ffi.cast("char *", pointer), lambda _pointer, owner=owner: None)
    memory = memoryview(ffi.buffer(alive, int(np.prod(shape)) * np.dtype(dtype).itemsize)).toreadonly()
    return np.frombuffer(memory, dtype).reshape(shape)


class _Looks:
    """What can be seen of a simulation: self._sim, which lives as long as self._owner."""

    @property
    def _view(self):
        return lib.uncross_sim_view(self._sim)

    def _vertices(self, name, dtype, *columns):
        return _array(self._owner, getattr(self._view, name), self._view.vertices, *columns, dtype=dtype)

    def _solvent(self, name, dtype):
        return _array(self._owner, getattr(self._view, name), self._view.particles, dtype=dtype)

    step = property(lambda self: lib.uncross_sim_step(self._sim), doc="Steps made.")
    time = property(lambda self: lib.uncross_sim_time(self._sim), doc="t0 since the start.")
    lag = property(lambda self: self._view.lag, doc="Time steps since the solvent was last streamed.")
    box = property(lambda self: np.array(list(self._view.cells)), doc="(3,) edges, a0.")
    positions = property(lambda self: self._vertices("position", np.int64, 3), doc="(vertices, 3) lattice units, unwrapped.")
    velocities = property(lambda self: self._vertices("velocity", np.float64, 3),
                          doc="(vertices, 3) a0/t0, half a step ahead.")
    mass = property(lambda self: self._vertices("mass", np.float64), doc="(vertices,) m.")
    next = property(lambda self: self._vertices("next", np.int32), doc="(vertices,) where the bond goes on to, or -1.")
    fiber = property(lambda self: self._vertices("fiber", np.uint32), doc="(vertices,) number of the fiber.")
    first = property(lambda self: _array(self._owner, self._view.first, self._view.fibers + 1, dtype=np.uint32),
                     doc="(fibers + 1,) first vertex of each fiber.")
    kind = property(lambda self: _array(self._owner, self._view.kind, self._view.fibers, dtype=np.uint32),
                    doc="(fibers,) number of the kind.")
    kinds = property(lambda self: [ffi.string(lib.uncross_sim_kind(self._sim, k)).decode()
                                   for k in range(self._view.kinds)], doc="Names of the kinds.")
    solvent_id = property(lambda self: self._solvent("id", np.uint32), doc="(particles,) who is who in memory.")
    solvent_x = property(lambda self: self._solvent("x", np.int64), doc="(particles,) lattice units, `lag` steps ago.")
    solvent_y = property(lambda self: self._solvent("y", np.int64), doc="As solvent_x.")
    solvent_z = property(lambda self: self._solvent("z", np.int64), doc="As solvent_x.")
    solvent_vx = property(lambda self: self._solvent("vx", np.float64), doc="(particles,) a0/t0, `lag` steps ago.")
    solvent_vy = property(lambda self: self._solvent("vy", np.float64), doc="As solvent_vx.")
    solvent_vz = property(lambda self: self._solvent("vz", np.float64), doc="As solvent_vx.")

    @property
    def hash(self):
        """The hash of the state, as `state_hash` of run.json."""
        value = ffi.new("uint64_t *")
        _check(lib.uncross_sim_hash, self._sim, value)
        return value[0]

    @property
    def warnings(self):
        """Sentences on what a reader of the results should know: those of the scene, and how a snapshot began the run."""
        return _told(lib.uncross_sim_warnings, self._sim)

    @property
    def counts(self):
        """Contacts of bonds so far: moves, possible, executed, negative."""
        counts = ffi.new("uncross_counts *")
        _check(lib.uncross_sim_counts, self._sim, counts)
        return {name: getattr(counts, name) for name in ("moves", "possible", "executed", "negative")}

    @property
    def conserved(self):
        """Energies (kT) and momentum (m a0/t0) at the time of the step."""
        c = ffi.new("uncross_conserved *")
        _check(lib.uncross_sim_conserved, self._sim, c)
        energies = {name: getattr(c, name) for name in ("solvent_kinetic", "vertex_kinetic", "bond", "bend", "total")}
        return {**energies, "momentum": np.array(list(c.momentum))}

    def positions_a0(self):
        """(vertices, 3) a0, unwrapped: a copy."""
        out = np.empty((self._view.vertices, 3))
        _check(lib.uncross_sim_positions, self._sim, ffi.from_buffer("double *", out))
        return out

    def solvent(self):
        """Positions (particles, 3) a0 and velocities (particles, 3) a0/t0 now, in the order of ids: copies."""
        position, velocity = np.empty((self._view.particles, 3)), np.empty((self._view.particles, 3))
        _check(lib.uncross_sim_solvent, self._sim, ffi.from_buffer("double *", position),
               ffi.from_buffer("double *", velocity))
        return position, velocity

    @property
    def tables(self):
        """{table: {column: (rows,) values}} of what the scene's `observe` asks for: copies."""
        tables, count = ffi.new("const uncross_table *const **"), ffi.new("size_t *")
        _check(lib.uncross_sim_tables, self._sim, tables, count)
        result = {}
        for k in range(count[0]):
            t = tables[0][k]
            values = np.array(_array(None, t.value, t.rows, t.columns, dtype=np.float64))
            result[ffi.string(t.name).decode()] = {ffi.string(t.column[c]).decode(): values[:, c].copy()
                                                   for c in range(t.columns)}
        return result


_PATIENCE = 0.1  # seconds between two looks at Ctrl-C, which Python sees only outside of the library


def _wanted(steps, done):
    """A number of steps that a run can make after those that it has made. The library sees only parts of it."""
    steps, most = operator.index(steps), 2**63 - 1 - done
    if not 0 <= steps <= most:
        raise BadInput(f"advance: {steps} steps; allowed: whole number 0 .. {most}")
    return steps


def _chunks(steps):
    """Numbers of steps that make up so many, each made in about _PATIENCE, or one step if that takes longer."""
    chunk = 1
    while steps > 0:
        chunk = min(chunk, steps)
        started = time.monotonic()
        yield chunk
        steps -= chunk
        took = max(time.monotonic() - started, 1e-6)
        chunk = max(1, int(chunk * min(2.0, _PATIENCE / took)))


class Run(_Looks):
    """A simulation in memory. Run(scene, **overrides): a Scene, a path, or a dictionary.

    resume: the path of a checkpoint to go on from.
    """

    def __init__(self, scene, *, resume=None, **overrides):
        scene = _scene(scene, overrides)
        handle = (scene._start(lib.uncross_sim_start) if resume is None
                  else scene._start(lib.uncross_sim_resume, _path(resume)))
        self._sim = self._owner = ffi.gc(handle, lib.uncross_sim_free)

    def advance(self, steps=1):
        """Makes so many time steps; returns the run."""
        for some in _chunks(_wanted(steps, self.step)):
            _check(lib.uncross_sim_advance, self._sim, some)
        return self

    def save(self, path):
        """Writes a checkpoint, in the place of an earlier one if there is one; of nothing else."""
        _check(lib.uncross_sim_save, self._sim, _path(path))


class FolderRun(_Looks):
    """What `uncross run` does: a folder with tables, trajectory, checkpoints and run.json. A context manager that closes
    the run at its end."""

    def __init__(self, scene, folder, *, resume=False, **overrides):
        scene = _scene(scene, overrides)
        mode = lib.UNCROSS_RESUME if resume else lib.UNCROSS_NEW
        self._run = self._owner = ffi.gc(scene._start(lib.uncross_run_open, _path(folder), mode), lib.uncross_run_free)
        self._sim = lib.uncross_run_sim(self._run)
        self.note = ffi.string(lib.uncross_run_note(self._run)).decode()

    wanted = property(lambda self: lib.uncross_run_wanted(self._run), doc="Steps wanted in all.")

    def advance(self, steps=None):
        """Makes so many steps (None: all that are wanted), up to the end; returns the run."""
        left = max(0, self.wanted - self.step)
        steps = left if steps is None else min(_wanted(steps, self.step), left)
        for some in _chunks(steps):
            _check(lib.uncross_run_advance, self._run, some, ffi.NULL, ffi.NULL)
        return self

    def save(self):
        """Writes checkpoint, averages and run.json now."""
        _check(lib.uncross_run_save, self._run)

    def close(self):
        """Saves, closes all files, lets go of the folder."""
        _check(lib.uncross_run_close, self._run)

    def __enter__(self):
        return self

    def __exit__(self, *_what):
        self.close()
