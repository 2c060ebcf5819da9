#!/usr/bin/python3
"""Writes the records of one case of the second truth: machine.toml, train-*.csv, held-*.csv, truth.json.

usage: generate.py KIND SEED --out DIR [--share 0.1] [--cause NAME] [--no-setpoints] [--cam]
  KIND: exact, tolerance, single, pair, triple, unknown, tight_spot
  --share: of each cause in the residual of the training logs; --cause: the (first) hidden cause of single, pair, triple
  --cam: motions of a slave behind a master, recorded while they run
"""

import argparse
import json
import pathlib
import time

import paths  # noqa: F401
import numpy as np

import case as cases
import causes
import machine_file
import records
import tolerance


def plain(value):
    """Numpy numbers as Python's."""
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    return value.item() if isinstance(value, np.generic) else value


def truth_of(case, found, off, share, held):
    """The content of truth.json but for the time that it took."""
    least, each, alias = cases.odds(case, found)
    named = [f for f in found if not f[0].name.startswith("unknown")]
    return plain({
        "kind": case.kind, "seed": case.seed, "share": share,
        "hidden": [f[0].name for f in named],
        "accept": {f[0].name: list(f[0].accept) for f in named},
        "unknown": [f[0].name for f in found if f[0].name.startswith("unknown")],
        "tolerated": tolerance.names(off), "off": off,
        "parameters": {f[0].name: f[0].facts(f[1]) for f in found},
        "shares": {f[0].name: f[3] for f in found},
        "shape": "; ".join(f"{f[0].name}: {f[0].shape}" for f in found),
        "oracle_nats": least, "oracle_nats_each": each, "oracle_alias_nats": alias,
        "machine": case.machine.facts(), "noise": case.noise.facts(),
        "noise_rms": float(np.sqrt(case.channel("force")[3])),
        "held_out_force": held,
        "train_s": [len(s) * case.session.tick for s in case.session.sets[:case.session.trained]]})


def generate(kind, seed, folder, share=0.1, name=None, setpoints=True, cam=False):
    """Writes the case into the folder and returns the truth."""
    began = time.process_time()
    case, found, off, logs = cases.build(kind, seed, share, name, cam)
    case.seed = seed
    folder.mkdir(parents=True, exist_ok=True)
    trained = case.session.trained
    for k, log in enumerate(logs):
        file = f"train-{k + 1}.csv" if k < trained else f"held-{k - trained + 1}.csv"
        master = None
        if cam:
            rows = case.before[k] // log.every
            master = case.masters[k][::log.every][rows:]
            log = log.behind(rows)
        records.write(log, folder / file, case.machine, setpoints, master)
    (folder / "machine.toml").write_text(machine_file.text(case.machine), encoding="utf-8")
    truth = truth_of(case, found, off, share, cases.held_out(case, logs))
    truth["seconds"] = time.process_time() - began
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")
    return truth


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("kind", choices=cases.KINDS)
    parser.add_argument("seed", type=int)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--share", type=float, default=0.1)
    parser.add_argument("--cause", choices=list(causes.CAUSES))
    parser.add_argument("--no-setpoints", action="store_true")
    parser.add_argument("--cam", action="store_true")
    options = parser.parse_args()
    truth = generate(options.kind, options.seed, options.out, options.share, options.cause, not options.no_setpoints,
                     options.cam)
    print(f"{options.out}: {truth['hidden'] or truth['unknown'] or 'nothing'} hidden, {truth['seconds']:.1f} s")


if __name__ == "__main__":
    main()
