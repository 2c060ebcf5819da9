"""What is counted over the cells: failures, of which some are known, and rates with the interval of Wilson (1927)."""

import dataclasses
import math
import tomllib


def wilson(hits, cases):
    """The 95 % interval of a rate."""
    if cases == 0:
        return 0.0, 1.0
    z = 1.959964
    rate = hits / cases
    middle = (rate + z * z / (2.0 * cases)) / (1.0 + z * z / cases)
    half = z / (1.0 + z * z / cases) * math.sqrt(rate * (1.0 - rate) / cases + z * z / (4.0 * cases * cases))
    return max(middle - half, 0.0), min(middle + half, 1.0)


def most_by_chance(rate, cases, chance):
    """The number of hits that cases of this rate exceed with a probability of at most `chance`."""
    above = 1.0
    for hits in range(cases + 1):
        above -= math.comb(cases, hits) * rate**hits * (1.0 - rate)**(cases - hits)
        if above <= chance:
            return hits
    return cases


@dataclasses.dataclass(frozen=True)
class Failure:
    """`what` is a few words that do not change from run to run; the detail is for the reader."""
    cell: str
    step: str
    what: str
    detail: str = ""


@dataclasses.dataclass(frozen=True)
class Known:
    """A failure that is known, with the reason that somebody found for it."""
    cell: str
    step: str
    what: str
    reason: str

    def covers(self, failure):
        return (self.cell, self.step, self.what) == (failure.cell, failure.step, failure.what)


class BadList(Exception):
    """The list of known failures is not one."""


def read_known(place):
    rows = tomllib.loads(place.read_text(encoding="utf-8")).get("known", [])
    known = []
    for row in rows:
        if set(row) != {"cell", "step", "what", "reason"} or not all(str(value).strip() for value in row.values()):
            raise BadList(f"{place}: found {row}; expected cell, step, what and reason, each with a text")
        if row["cell"].count("/") != 3:
            raise BadList(f"{place}: found the cell '{row['cell']}'; expected MACHINE/AXIS/MODEL/SEED")
        known.append(Known(**row))
    if len(set(known)) != len(known):
        raise BadList(f"{place}: found the same row twice")
    return known


def sort_out(failures, known, ran):
    """Failures that nobody knows, those that are known, and known ones that passed although their cell ran."""
    unknown = [failure for failure in failures if not any(row.covers(failure) for row in known)]
    expected = [failure for failure in failures if any(row.covers(failure) for row in known)]
    healed = [row for row in known if row.cell in ran and not any(row.covers(failure) for failure in failures)]
    return unknown, expected, healed


@dataclasses.dataclass
class Rate:
    """Cases counted over all cells, with the least and the most that is wanted of them."""
    name: str
    least: float = 0.0
    most: float = 1.0
    hits: int = 0
    cases: int = 0
    groups: dict = dataclasses.field(default_factory=dict)  # hits and cases of those that hang together

    def add(self, hit, group=None):
        """`group`: cases of one record are no pieces of evidence of their own: what misses one misses the others."""
        self.hits += bool(hit)
        self.cases += 1
        hits, cases = self.groups.get(group, (0, 0))
        self.groups[group] = (hits + bool(hit), cases + 1)

    def interval(self):
        """Wilson's, of as many cases as the groups are worth: fewer by the design effect (Kish, Survey Sampling, 1965,
        8.2), by which the rate scatters more from group to group than that of single cases would."""
        rate = self.hits / self.cases if self.cases else 0.0
        effect = 1.0
        if len(self.groups) > 1 and 0.0 < rate < 1.0:
            spread = sum((hits - rate * cases)**2 for hits, cases in self.groups.values())
            spread *= len(self.groups) / (len(self.groups) - 1)
            effect = max(spread / (self.cases * rate * (1.0 - rate)), 1.0)
        return wilson(self.hits / effect, self.cases / effect)

    def holds(self, exactly):
        """Whether the rate lies in what is wanted: its point where there are many cases, else its interval overlaps."""
        if self.cases == 0:
            return True
        low, high = (self.hits / self.cases,) * 2 if exactly else self.interval()
        return low <= self.most and high >= self.least

    def text(self):
        low, high = self.interval()
        rate = f"{100.0 * self.hits / self.cases:.1f} %" if self.cases else "no case"
        return (f"{self.name}: {self.hits} of {self.cases}, {rate} (95 % interval {100.0 * low:.1f} to "
                f"{100.0 * high:.1f} %)")
