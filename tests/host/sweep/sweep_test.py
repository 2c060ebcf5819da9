#!/usr/bin/env python3
"""Sweeps as their users run them: the table read by NumPy alone, rows repeated by their own commands, the same bytes from
any number of threads and MPI ranks, and after every kind of end.

usage: sweep_test.py STICTION SCHEMA [MPIRUN]
"""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy

STICTION, SCHEMA = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
MPIRUN = sys.argv[3] if len(sys.argv) > 3 else ""

# An axis with a loop of 1 ms: a run takes few milliseconds. One friction model is not there, so that runs fail.
SPEC = """schema = "stiction.sweep-spec/1"
name = "test"
command = "simulate circle"
machine = "emps"
pareto = ["peak_error", "peak_voltage_X"]
[option]
friction = ["coulomb_viscous", "lugre"]
feed = "2 m/min"
[set]
"axis.X.mass" = { distribution = "uniform", from = 0.9, to = 1.1, relative = true }
"axis.X.position_controller.gain" = { from = "120 1/s", to = "160 1/s", steps = 2 }
[sample]
number = ROWS
"""


def environment(**more):
    env = {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMI_", "SLURM_"))}
    return env | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                  "OMPI_MCA_rmaps_base_oversubscribe": "1"} | more


class Sweeps(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="stiction-sweep-"))
        self.addCleanup(shutil.rmtree, self.folder, True)

    def spec(self, rows=3, text=SPEC):
        file = self.folder / "spec.toml"
        file.write_text(text.replace("ROWS", str(rows)))
        return file

    def run_program(self, *arguments, program=STICTION, before=(), **env):
        return subprocess.run([*before, program, *map(str, arguments)], cwd=self.folder, env=environment(**env),
                              capture_output=True, text=True, check=False)

    def sweep(self, out, *more, spec=None, before=(), program=STICTION):
        result = self.run_program("sweep", spec or self.folder / "spec.toml", "--out", out, *more, before=before,
                                  program=program)
        return result

    def table(self, out):
        return (self.folder / out / "sweep.npz").read_bytes()

    def test_numpy_reads_the_table_and_each_row_is_repeated_by_its_command(self):
        self.spec()
        result = self.sweep("a", "--json")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        summary = json.loads(result.stdout)
        with numpy.load(self.folder / "a" / "sweep.npz", allow_pickle=False) as table:
            columns = {name: table[name] for name in table.files}
        self.assertEqual(list(columns), summary["columns"] + ["status", "message", "command"])
        self.assertTrue(all(len(values) == 12 for values in columns.values()))
        self.assertEqual(list(columns["status"]), ["done"] * 6 + ["failed"] * 6)
        self.assertEqual(summary["failed"], 6)
        self.assertIn("--friction: found 'lugre'", columns["message"][6])
        self.assertTrue(numpy.isnan(columns["peak_error[um]"][6:]).all())
        self.assertEqual(list(columns["axis.X.position_controller.gain[1/s]"][:6]), [120.0] * 3 + [160.0] * 3)
        self.assertTrue(((columns["axis.X.mass[relative]"] > 0.9) & (columns["axis.X.mass[relative]"] < 1.1)).all())
        self.assertEqual(len(set(columns["peak_error[um]"][:6])), 6)
        for row in (0, 5):
            line = f"'{STICTION}'" + columns["command"][row].removeprefix("stiction") + " --json"
            alone = json.loads(subprocess.run(line, shell=True, env=environment(), capture_output=True, text=True,
                                              check=True).stdout)["rows"][0]
            self.assertEqual(alone["peak_error_um"], columns["peak_error[um]"][row])
            self.assertEqual(alone["peak_voltage_V"], columns["peak_voltage_X[V]"][row])
        worst = summary["worst"]
        self.assertEqual(worst["value"], numpy.nanmax(columns["peak_error[um]"]))
        self.assertEqual(worst["command"], columns["command"][worst["row"]])
        self.assertFalse((self.folder / "a" / ".sweep" / "chunks").exists(), "chunks are gone when the table is there")
        page = (self.folder / "a" / "report.html").read_text()
        self.assertIn("Pareto front", page)
        try:
            import jsonschema
        except ImportError:
            self.skipTest("jsonschema is not installed")
        jsonschema.validate(summary, json.loads(SCHEMA.read_text()))

    def test_threads_and_ranks_give_the_same_bytes(self):
        self.spec(10)
        self.assertEqual(self.sweep("one", "--threads", "1").returncode, 0)
        self.assertEqual(self.sweep("three", "--threads", "3").returncode, 0)
        self.assertEqual(self.table("one"), self.table("three"))
        if not MPIRUN:
            self.skipTest("no mpirun")
        for ranks in ("1", "2", "4"):
            result = self.sweep("mpi" + ranks, before=(MPIRUN, "-n", ranks))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stdout.count("runs of"), 1, "one rank speaks")
            self.assertEqual(self.table("one"), self.table("mpi" + ranks), ranks)

    def test_a_finished_sweep_is_told_again_and_not_run(self):
        self.spec()
        first = self.sweep("a")
        written = (self.folder / "a" / "sweep.npz").stat().st_mtime_ns
        again = self.sweep("a")
        self.assertEqual((again.returncode, again.stdout), (0, first.stdout))
        self.assertEqual((self.folder / "a" / "sweep.npz").stat().st_mtime_ns, written)

    def chunks(self, out):
        return sorted((self.folder / out / ".sweep" / "chunks").glob("*.chunk"))

    def interrupted(self, out, how, processes=1, least=5):
        """Ends the first of some sweeps at `least` chunks; returns its last words, and the other processes."""
        running = [subprocess.Popen([STICTION, "sweep", self.folder / "spec.toml", "--out", out, "--threads", "1"],
                                    cwd=self.folder, env=environment(), stdout=subprocess.DEVNULL,
                                    stderr=subprocess.PIPE, text=True) for _ in range(processes)]
        while len(self.chunks(out)) < least:
            self.assertIsNone(running[0].poll(), "it ended by itself")
            time.sleep(0.005)
        running[0].send_signal(how)
        words = running[0].communicate()[1]
        self.assertEqual(running[0].returncode, -how)
        return words, running[1:]

    def test_it_resumes_after_a_kill_and_after_an_interruption_with_the_same_bytes(self):
        self.spec(500)
        self.assertEqual(self.sweep("whole").returncode, 0)
        self.interrupted("a", signal.SIGKILL)
        before = len(self.chunks("a"))
        self.assertGreaterEqual(before, 5)
        self.assertFalse((self.folder / "a" / "sweep.npz").exists())
        words, _ = self.interrupted("a", signal.SIGINT, least=before + 5)
        self.assertEqual(words, "stiction: interrupted; the same command resumes the sweep in a\n")
        kept = self.chunks("a")
        self.assertGreaterEqual(len(kept), before)
        kept[2].write_bytes(kept[2].read_bytes()[:-9])  # a disk that lost the end of one
        self.assertEqual(self.sweep("a").returncode, 0)
        self.assertEqual(self.table("a"), self.table("whole"))

    def test_the_chunk_of_a_process_that_was_killed_is_done_by_the_other(self):
        self.spec(500)
        self.assertEqual(self.sweep("whole").returncode, 0)
        _, others = self.interrupted("a", signal.SIGKILL, processes=2)
        others[0].communicate()
        self.assertEqual(others[0].returncode, 0)
        self.assertEqual(self.table("a"), self.table("whole"))

    def test_a_different_programme_or_specification_is_refused(self):
        self.spec(500)
        self.interrupted("a", signal.SIGKILL)
        other = self.folder / "bin" / "stiction"
        other.parent.mkdir()
        shutil.copy(STICTION, other)
        with other.open("ab") as file:
            file.write(b"x")
        result = self.run_program("sweep", "spec.toml", "--out", "a", program=other,
                                  STICTION_MACHINES=str(STICTION.parent.parent / "share/stiction/machines"))
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, "found a sweep by stiction .*, build [0-9a-f]{16}; expected one by the programme")
        self.spec(501)
        result = self.sweep("a")
        self.assertEqual(result.returncode, 2)
        self.assertIn("a: found the sweep of a different specification", result.stderr)

    def test_bad_input_leaves_nothing(self):
        def refused(words, *more, text=SPEC, rows=3):
            result = self.sweep("none", *more, spec=self.spec(rows, text))
            self.assertEqual((result.returncode, words in result.stderr), (2, True), result.stderr)
            self.assertFalse((self.folder / "none").exists(), words)

        refused("which take about", rows=10**9)
        refused("expected at most 10 min, or --yes", rows=10**9)
        refused('figures: found "peak_eror", which no run gives; expected one of peak_error',
                text='figures = ["peak_eror"]\n' + SPEC)
        refused('pareto: found "peak_current_X", which no run gives', text=SPEC.replace("peak_voltage_X", "peak_current_X"))
        refused("none of the 5 runs that were tried succeeds, the first: --set axis.X.mas",
                text=SPEC.replace("[sample]", '"axis.X.mas" = "3 kg"\n[sample]'))
        refused("found an empty list", text=SPEC.replace('"2 m/min"', "[]"))
        refused("--threads: found '0'", "--threads", "0")
        result = self.run_program("sweep", "nothing", "--out", "none")
        self.assertIn("sweep \"nothing\": found no such sweep; expected the path of a file or the name of a shipped sweep",
                      result.stderr)
        (self.folder / "file").write_text("")
        result = self.sweep("file/a", spec=self.spec())
        self.assertEqual((result.returncode, "expected a folder" in result.stderr), (2, True), result.stderr)
        (self.folder / "full").mkdir()
        (self.folder / "full" / "mine.txt").write_text("mine")
        result = self.sweep("full", spec=self.spec())
        self.assertEqual(result.returncode, 2)
        self.assertIn("full: found files that are no sweep", result.stderr)

    def test_a_full_disk_stops_it_and_it_resumes(self):
        self.spec(10)
        self.assertEqual(self.sweep("whole").returncode, 0)
        # Files of at most 4 blocks of 512 bytes: chunks fit, the page does not.
        result = self.run_program("-c", f"ulimit -f 4; exec '{STICTION}' sweep spec.toml --out a", program="/bin/sh")
        self.assertEqual((result.returncode, "the file becomes larger than the system allows" in result.stderr),
                         (1, True), result.stderr)
        self.assertFalse((self.folder / "a" / "sweep.npz").exists())
        self.assertEqual(self.sweep("a").returncode, 0)
        self.assertEqual(self.table("a"), self.table("whole"))

    def test_the_script_of_a_slurm_job_shares_one_folder(self):
        self.spec()
        result = self.sweep("a", "--slurm", "job.sh", "--tasks", "3", "--threads", "2", "--yes")
        self.assertEqual(result.returncode, 0, result.stderr)
        script = (self.folder / "job.sh").read_text()
        self.assertIn("#SBATCH --array=0-2\n#SBATCH --cpus-per-task=2\n", script)
        self.assertFalse((self.folder / "a").exists())
        bash = self.folder / "stiction"
        bash.symlink_to(STICTION)
        # Two tasks at once, as the batch system starts them.
        tasks = [subprocess.Popen(["bash", "job.sh"], cwd=self.folder, stdout=subprocess.PIPE, text=True,
                                  env=environment(PATH=f"{self.folder}:{os.environ['PATH']}", SLURM_ARRAY_TASK_ID=str(k),
                                                  SLURM_ARRAY_TASK_COUNT="2")) for k in (0, 1)]
        outs = [task.communicate()[0] for task in tasks]
        self.assertEqual([task.returncode for task in tasks], [0, 0])
        self.assertEqual([bool(out) for out in outs], [True, False], "the first task speaks")
        self.assertEqual(self.sweep("b").returncode, 0)
        self.assertEqual(self.table("a"), self.table("b"))

    def test_logs_are_identified_and_diagnosed_as_by_the_commands_themselves(self):
        made = self.run_program("simulate", "commissioning", "--machine", "emps", "--out", "records", "--json")
        self.assertEqual(made.returncode, 0, made.stderr)
        text = """schema = "stiction.sweep-spec/1"
command = "COMMAND"
machine = "emps"
log = LOGS
"""
        logs = ["records/speeds.csv", "records/circle.csv"]
        result = self.sweep("i", spec=self.spec(1, text.replace("COMMAND", "identify").replace("LOGS", str(logs))))
        self.assertEqual(result.returncode, 0, result.stderr)
        table = numpy.load(self.folder / "i" / "sweep.npz")
        for row, log in enumerate(logs):
            alone = json.loads(self.run_program("identify", log, "--machine", "emps", "--json").stdout)["parameters"]
            for name, parameter in alone.items():
                self.assertEqual([table[name + end][row] for end in ("", "_low", "_high")],
                                 [parameter["value"], *parameter["ci95"]], f"{log}: {name}")
        result = self.sweep("d", spec=self.spec(1, text.replace("COMMAND", "diagnose").replace("LOGS", str(logs[1:]))))
        self.assertEqual(result.returncode, 0, result.stderr)
        table = numpy.load(self.folder / "d" / "sweep.npz")
        alone = json.loads(self.run_program("diagnose", logs[1], "--machine", "emps", "--json").stdout)
        self.assertEqual(table["findings"][0], len(alone["findings"]))
        self.assertEqual(table["baseline_force_rms[N]"][0], alone["baseline"]["force_rms_N"])

    def test_the_shipped_sweeps_run(self):
        folder = STICTION.parent.parent / "share/stiction/sweeps"
        for name, number in (("robust-friction", "number = 1000"), ("circle-sensitivity", "number = 512")):
            text = (folder / f"{name}.toml").read_text()
            self.assertIn(number, text)
            text = text.replace(number, "number = 2")
            file = self.folder / f"{name}.toml"
            file.write_text(text)
            result = self.sweep(name, "--json", spec=file)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(json.loads(result.stdout)["failed"], 0)
        robust = json.loads((self.folder / "robust-friction" / "sweep.json").read_text())["robust"]
        self.assertEqual(len(robust["choices"]), 4)
        self.assertLessEqual(robust["best"]["worst"], robust["nominal"]["worst"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
