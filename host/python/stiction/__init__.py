"""Servo axes with friction: simulation with the firmware in the loop, identification, diagnosis, tuning.

Every function calls the library that the command of the same name calls; options have the command's names (with "_" for
"-") and its texts, "16 m/min". docs/python.md has examples.
"""

import inspect as _inspect
import json as _json
import os as _os
import tempfile as _tempfile
from collections.abc import Mapping as _Mapping

import numpy as _np

from . import _core
from ._core import BENCH_STEP, Error, Fault, InputError, Machine

__version__ = _core.version()
__all__ = ["BENCH_STEP", "Error", "Fault", "InputError", "Log", "Machine", "Result", "batch", "bench", "commands",
           "diagnose", "fleet", "frequency_response", "identify", "instruction_sets", "machine", "options", "read_log",
           "read_segments", "replay", "shipped_machines", "simulate", "tune_friction"]

shipped_machines = _core.shipped_machines
instruction_sets = _core.instruction_sets


class Log(_Mapping):
    """A log: a mapping from a column's name, "X.x", to its values in SI units.

    The arrays are views of the library's own memory: nothing is copied, and they cannot be written. Each keeps that
    memory as long as it is there itself. A blank cell of a file is NaN.
    """

    def __init__(self, core, run=""):
        self._core = core
        self._arrays = core.arrays()
        self.units = core.units()
        self.run = run

    def __getitem__(self, name):
        try:
            return self._arrays[name]
        except KeyError:
            raise KeyError(f"found no column {name!r}; expected one of {', '.join(self._arrays)}") from None

    def __iter__(self):
        return iter(self._arrays)

    def __len__(self):
        return len(self._arrays)

    def __repr__(self):
        return f"<stiction.Log of {len(self['t'])} samples: {', '.join(self._arrays)}>"

    @property
    def period(self):
        """Seconds between two samples."""
        return self._core.period

    @property
    def source(self):
        """The file's name; empty for a simulated log."""
        return self._core.source

    @property
    def comments(self):
        """The comments of the file, "# key: value", by key."""
        return dict(self._core.comments)

    @property
    def ignored(self):
        """Headers of columns that have no meaning here."""
        return list(self._core.ignored)

    @property
    def notes(self):
        """Sentences on what the reading step made of the record."""
        return list(self._core.notes)

    @property
    def left_out(self):
        """By axis, where it has some: which samples no fit may use."""
        return self._core.left_out()

    def write(self, path):
        """Writes the log as a file that every command reads (CSV)."""
        self._core.write(_os.fspath(path))


class Result(dict):
    """The document that the command prints with --json.

    `logs` has the runs that were kept, in their order; `arrays` the columns of a fleet's estimates, by name.
    """

    def __init__(self, document, logs=(), arrays=()):
        super().__init__(document)
        self.logs = list(logs)
        self.arrays = dict(arrays)


def _names(values):
    """One value or several as a list of texts."""
    if values is None:
        return []
    if isinstance(values, (str, bytes, _os.PathLike)):
        values = [values]
    return [_os.fspath(value) for value in values]


def machine(name_or_path, set=None):
    """The machine that ships under this name, or that of a file; `set`: "KEY=VALUE", or several, as --set takes them.

    A Machine has id, name, file, set, period (s), axes (kind, mass in kg, friction law in use) and sheet: rows of
    (section, axis, label, unit, value).
    """
    if isinstance(name_or_path, Machine):
        return Machine(name_or_path.file, [*name_or_path.set, *_names(set)]) if set else name_or_path
    return Machine(_os.fspath(name_or_path), _names(set))


def _text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return ",".join(str(each) for each in value)
    return str(value) if not isinstance(value, _os.PathLike) else _os.fspath(value)


_REPEATED = ("fix", "holdout")  # options that may be given several times


_OF_EFFECTS = "time, position, speed, motor_force"


def _functions(effects):
    """The functions of `effects` as pairs of axis and function, each of which takes the arguments of an effect."""
    pairs = []
    for axis, functions in (effects or {}).items():
        for function in functions if isinstance(functions, (list, tuple)) else [functions]:
            if not callable(function):
                raise InputError(f"effect on axis {axis}: found {type(function).__name__}; expected a function of "
                                 f"({_OF_EFFECTS})")
            try:
                signature = _inspect.signature(function)
            except (TypeError, ValueError):  # of C, without a signature: the call itself will tell
                signature = None
            try:
                if signature is not None:
                    signature.bind(0.0, 0.0, 0.0, 0.0)
            except TypeError:
                name = getattr(function, "__name__", type(function).__name__)
                raise InputError(f"effect on axis {axis}: found {name}{signature}; expected a function of "
                                 f"({_OF_EFFECTS})") from None
            pairs.append((axis, function))
    return pairs


def _answer(command, on, logs, options, keep_logs, progress, set, effects=None):
    pairs = []
    for name, value in options.items():
        if value is None:
            continue
        name = name.replace("_", "-")
        for each in _names(value) if name in _REPEATED else [value]:
            pairs.append((name, _text(each)))
    document, kept = _core.answer(command, machine(on, set), _names(logs), pairs, keep_logs, _functions(effects),
                                    progress)
    return Result(_json.loads(document), [Log(log, run) for run, log in kept])


def simulate(experiment, machine, *, set=None, logs=False, effects=None, progress=None, **options):
    """`stiction simulate EXPERIMENT`: the firmware controls the simulated machine.

    experiment: "circle", "l-shape", "cam", ... (commands() lists all); machine: a Machine, a name or a path; set:
    assignments for this call; options: those of the command, friction="lugre", feed=["8 m/min", "16 m/min"]. logs=True
    keeps every run as a Log in Result.logs. progress is called with a text now and then; what it raises ends the call,
    as Ctrl-C does.

    effects: {"X": function}, or a list of functions an axis: forces on the carriage in addition to the effects of
    the machine file. A function takes (time, position, speed, motor_force), s, m, m/s and N, at the beginning of
    a step of the plant, and returns a force in N, positive in the direction of the position; of a rotary axis it is
    rad, rad/s and N m. It is called once or several times in each of the four steps of a tick, also by several runs at
    once, so its value must depend on its arguments alone. This is the slow path, for studies. What a function raises
    ends the call.
    """
    return _answer(f"simulate {experiment}", machine, [], options, logs, progress, set, effects)


def replay(log, machine, *, set=None, logs=False, effects=None, progress=None, **options):
    """`stiction simulate replay`: the set-points of a log (a path) through the simulated machine, against what the log
    has measured. logs=True keeps the simulated log of each friction model; effects: as of simulate()."""
    return _answer("simulate replay", machine, log, options, logs, progress, set, effects)


def frequency_response(machine, log=None, *, set=None, logs=False, effects=None, progress=None, **options):
    """`stiction simulate frequency-response`: the loops of a simulated machine, or of a log (a path) with a test signal.

    logs=True keeps the log of the simulated test; effects: as of simulate().
    """
    return _answer("simulate frequency-response", machine, log, options, logs, progress, set, effects)


def identify(logs, machine, *, set=None, progress=None, **options):
    """`stiction identify`: mass and friction of an axis from logs; logs: one path or several."""
    return _answer("identify", machine, logs, options, False, progress, set)


def diagnose(logs, machine, *, set=None, progress=None, **options):
    """`stiction diagnose`: causes of deviations between logs and the machine file. progress is told each part."""
    return _answer("diagnose", machine, logs, options, False, progress, set)


def tune_friction(machine, logs=None, *, set=None, progress=None, **options):
    """`stiction tune-friction`: the friction compensation tuned, and compared before and after."""
    return _answer("tune-friction", machine, logs, options, False, progress, set)


def fleet(list, out=None, *, threads=0, false_alarms=0.005, full=False, diagnosis=True, progress=None):
    """`stiction fleet`: trends of mass and friction of many axes from their records over months, with alarms.

    list: a path of a list of records (docs/scale.md), or of its folder; out: the folder of the results, in which judged
    records are kept for the next call; None: nothing is kept. threads: 0 for all processors; false_alarms: expected of
    an axis in a year; full: diagnose every record; diagnosis=False: diagnose none. Result.arrays has the estimates, an
    array a column ("axis", "date", "parameter", "value", "standard_error", "deviation", ...), a row for each record and
    parameter.
    """
    with _tempfile.TemporaryDirectory(prefix="stiction-fleet-") as place:
        folder = place if out is None else _os.fspath(out)
        document = _core.fleet(_os.fspath(list), folder, threads, false_alarms, full, not diagnosis, progress)
        with _np.load(_os.path.join(folder, "fleet.npz"), allow_pickle=False) as table:
            return Result(_json.loads(document), arrays={name: table[name] for name in table.files})


def commands():
    """Names of the commands that the functions call, "simulate circle"."""
    return _core.commands()


def options(command):
    """Names of the options of a command, as the functions take them."""
    return [name.replace("-", "_") for name in _core.options(command)]


def read_segments(path, columns=""):
    """All segments of a record, which is several logs where it has gaps. columns: of a table without a header."""
    return [Log(log) for log in _core.read_log(_os.fspath(path), columns)]


def read_log(path, columns=""):
    """The log of a file in any of the formats of docs/formats.md; a record with gaps is refused: see read_segments."""
    segments = read_segments(path, columns)
    if len(segments) != 1:
        raise InputError(f"{_os.fspath(path)}: found a record of {len(segments)} segments; expected one, or "
                         "read_segments()")
    return segments[0]


def _set_points(name, values, period, size, of=None):
    """`values` as rows of a value, or of one a member; without any the derivative of `of`, central differences."""
    if values is None:
        values = _np.gradient(of, period, axis=0) if len(of) > 1 else _np.zeros_like(of)
    values = _np.ascontiguousarray(values, dtype=float)
    if values.ndim == 1:
        values = values[:, _np.newaxis]
    if values.ndim != 2 or values.shape[1] not in (1, size):
        raise InputError(f"{name}: found an array of shape {values.shape}; expected (ticks,), (ticks, 1) or "
                         f"(ticks, {size}), one column for all members or one of each")
    if of is not None and values.shape != of.shape:
        raise InputError(f"{name}: found the shape {values.shape}; expected that of x_set, {of.shape}")
    return values


def batch(members, x_set, v_set=None, a_set=None, *, rows=("x", "e", "i_set"), every=1, instruction_set="",
          progress=None):
    """Many axes in closed loop at once, each as it would be alone, to the bit; the cascade in double precision.

    members: a Machine of one axis, or (Machine, "X"), each; their loops have one period. x_set (m), v_set (m/s),
    a_set (m/s^2): a value a tick for all members, or a row of one of each; what is not given is derived by central
    differences. An axis begins at rest at its first x_set. Returns a dictionary: of each of `rows` an array with a row a
    kept tick (`every`-th) and a column a member, and "fault", a number a member, 0 for none.
    """
    members = [each if isinstance(each, tuple) else (each, "") for each in members]
    if not members:
        raise InputError("members: found none; expected at least one")
    loaded = [(machine(one), axis) for one, axis in members]
    if int(every) < 1:
        raise InputError(f"every: found {every}; expected at least 1")
    period = loaded[0][0].period
    x = _set_points("x_set", x_set, period, len(loaded))
    if len(x) == 0:
        raise InputError("x_set: found no tick; expected at least one")
    v = _set_points("v_set", v_set, period, len(loaded), x)
    a = _set_points("a_set", a_set, period, len(loaded), x if a_set is not None else v)
    starts = _np.broadcast_to(x[0], (len(loaded),))
    rows = _names(rows)
    return _core.batch([(one, axis, float(start)) for (one, axis), start in zip(loaded, starts)], x, v, a, rows,
                       int(every), instruction_set, progress)


def bench(law, force, *, axis="", friction="", mass=None):
    """A mass on a surface, without a drive, under `force` (N), a value a step of BENCH_STEP seconds.

    law: a Machine (a name, a path), whose axis `axis` lies on its law `friction`; or an object of Python with
    advance(velocity, force), which returns the velocity (m/s) at the end of a step, for a mass `mass` (kg). The latter is
    the slow path, for studies: a call of Python a step. Returns x (m), v (m/s) and friction (N, mean of the step) after
    each step.
    """
    force = _np.ascontiguousarray(force, dtype=float)
    if force.ndim != 1:
        raise InputError(f"force: found an array of shape {force.shape}; expected one value a step")
    if isinstance(law, (Machine, str, _os.PathLike)):
        if mass is not None:
            raise InputError("mass: found one; expected none, as the machine has its own")
        loaded = machine(law)
        return _core.bench_of_machine(loaded, axis or next(iter(loaded.axes)), friction, force)
    if not callable(getattr(law, "advance", None)):
        raise InputError(f"law: found {type(law).__name__} without advance(); expected a machine, or an object with "
                         "advance(velocity, force)")
    if mass is None or not mass > 0.0:
        raise InputError(f"mass: found {'none' if mass is None else mass}; expected the mass in kg, above zero")
    return _core.bench_of_law(law, float(mass), force)
