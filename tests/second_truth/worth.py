"""What a finding is worth beyond its name: its gain on held-out records, its intervals."""

import math

NORMAL = 1.959964  # a 95 % interval is so many standard errors wide to either side
UNITS = ("kg", "kg_m2", "N", "N_m", "N_s_per_m", "N_m_s_per_rad", "s", "m", "rad", "N_per_A", "N_m_per_A", "Hz", "per_s",
         "A_s_per_m", "A_s_per_rad")
# Where truth and verdict describe a cause by the same number: its name in truth.json, its name in the verdict.
NUMBERS = {
    "mass_mismatch": ("mass", "mass"), "coulomb_mismatch": ("coulomb", "coulomb"),
    "viscous_mismatch": ("viscous", "viscous"), "constant_force": ("force", "force"),
    "force_constant_mismatch": ("force_constant", "force_constant"), "force_ripple": ("pitch", "pitch"),
    "force_constant_ripple": ("pitch", "pitch"), "encoder_subdivision_error": ("period", "period"),
    "backlash": ("width", "width"), "structural_resonance": ("frequency_Hz", "frequency"),
    "time_skew": ("delay", "delay"), "periodic_disturbance": ("frequency_Hz", "frequency"),
    "master_delay": ("delay", "delay")}
# Of these the truth has several harmonics, and each that was found is a wave of its own.
LONGEST = {"force_ripple", "force_constant_ripple", "encoder_subdivision_error"}
SLOWEST = {"periodic_disturbance"}
LEAST_GAIN = 0.005  # of the held-out variance, below which the noise of a record decides what a gain is
WORSE = 1.1  # times the file's error in held-out position


def of_first_harmonic(effect, value, truth):
    """Factor that makes a wave's length or frequency that of the first harmonic."""
    if effect in LONGEST:
        return max(1, round(truth / value))
    return 1 / max(1, round(value / truth)) if effect in SLOWEST else 1


def intervals(line):
    """Whether the interval of each comparable number of the right findings covers it."""
    out = []
    for finding in line["findings"]:
        truth = line["parameters"].get(finding["effect"])
        names = NUMBERS.get(finding["effect"])
        if not truth or not names or names[0] not in truth:
            continue
        for key, value in finding["parameters"].items():
            error = (finding["standard_errors"] or {}).get(key)
            if key.removeprefix(names[1] + "_") in UNITS and error:
                times = of_first_harmonic(finding["effect"], value, truth[names[0]])
                out.append(abs(times * value - truth[names[0]]) <= NORMAL * times * error)
    return out


def oracle_gain(line):
    """Share of the held-out residual force's mean square that what is hidden has; None where it is not known."""
    powers = line["held_out_force"]
    return 1 - powers[1] / powers[0] if powers else None


def has_gain(line):
    """What is hidden shows in the held-out force."""
    found = oracle_gain(line)
    return found is not None and found >= LEAST_GAIN and bool(line["baseline"]) and "force_rms_N" in same_unit(line)


def same_unit(line):
    """The baseline with its force under the key of a linear axis."""
    return {key.replace("N_m", "N"): value for key, value in line["baseline"].items()}


def gain(lines):
    """What the extended machines take off the held-out force, in % of what is hidden there: of sums over the lines of
    relative mean squares."""
    got = 0.0
    for line in lines:
        key = next(key for key in line["baseline"] if key.startswith("force_rms"))
        got += 1 - (line["extended"][key] / line["baseline"][key]) ** 2
    return 100 * got / math.fsum(oracle_gain(line) for line in lines)


def of_coordinates(line):
    """What has no name is a function of two coordinates, and no event."""
    return any(" and " in form for form in line["unknown"])


def positions(line):
    """Held-out position errors of file and extended machine; empty where there are none."""
    key = next((key for key in line["baseline"] or {} if key.startswith("position_error")), None)
    return [part[key] for part in (line["baseline"], line["extended"]) if key in part] if key else []


def has_positions(line):
    """A name was given, and both machines were driven over held-out set-points."""
    return bool(line["names"]) and len(positions(line)) == 2


def position_is_worse(line):
    """The extended machine follows held-out positions worse than the file by more than 10 %."""
    file, extended = positions(line)
    return extended > WORSE * file
