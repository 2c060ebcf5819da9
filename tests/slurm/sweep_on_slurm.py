"""Sweeps as array jobs of a Slurm that runs: the table is that of one process, also after a task was killed.

usage: sweep_on_slurm.py STICTION, where sbatch, squeue and scancel find a cluster (toolchain/slurm/one_node)
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

STICTION = pathlib.Path(sys.argv[1]).resolve()

# A circle takes about 40 ms: the array runs long enough for its end to be seen coming.
SPEC = """schema = "stiction.sweep-spec/1"
name = "on Slurm"
command = "simulate circle"
machine = "mcfv5050ln"
[option]
feed = "16 m/min"
[set]
"axis.X.mass" = { distribution = "uniform", from = 0.9, to = 1.1, relative = true }
[sample]
number = ROWS
"""


class OnSlurm(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="stiction-slurm-"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        # The job begins with the path of who submits it.
        (self.folder / "bin").mkdir()
        (self.folder / "bin" / "stiction").symlink_to(STICTION)
        self.environment = os.environ | {"PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}"}

    def run_here(self, *command, check=True):
        result = subprocess.run(command, cwd=self.folder, env=self.environment, capture_output=True, text=True, check=False)
        if check:
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result

    def table(self, out):
        return (self.folder / out / "sweep.npz").read_bytes()

    def write_job(self, rows, tasks):
        (self.folder / "spec.toml").write_text(SPEC.replace("ROWS", str(rows)))
        self.run_here("stiction", "sweep", "spec.toml", "--out", "alone", "--threads", "1")
        self.run_here("stiction", "sweep", "spec.toml", "--out", "slurm", "--slurm", "job.sh", "--tasks", str(tasks),
                      "--threads", "1")

    def logs(self):
        return {file.name: file.read_text() for file in sorted(self.folder.glob("stiction-sweep-*.log"))}

    def test_tasks_of_an_array_give_the_table_of_one_process(self):
        self.write_job(rows=60, tasks=2)
        self.run_here("sbatch", "--wait", "job.sh")
        self.assertEqual(self.table("slurm"), self.table("alone"))
        self.assertEqual(len(self.logs()), 2, "each task has a log of its own")

    def test_what_a_killed_task_had_taken_is_done_by_the_others_and_the_job_may_be_submitted_again(self):
        self.write_job(rows=400, tasks=2)
        said = self.run_here("sbatch", "job.sh").stdout
        job = re.search(r"\d+", said)[0]
        begins = time.monotonic()
        while not any((self.folder / "slurm" / ".sweep").glob("chunks/*")):
            self.assertLess(time.monotonic() - begins, 300, f"no chunk is done: {self.logs()}")
            time.sleep(0.05)
        self.run_here("scancel", "--signal=KILL", f"{job}_0")
        while self.run_here("squeue", "--noheader", f"--jobs={job}", check=False).stdout.strip():
            self.assertLess(time.monotonic() - begins, 600, f"the job does not end: {self.logs()}")
            time.sleep(0.2)
        self.assertEqual(self.table("slurm"), self.table("alone"), "the second task does what the first had taken")
        # Both killed: the same script goes on with what is there.
        shutil.rmtree(self.folder / "slurm")
        job = re.search(r"\d+", self.run_here("sbatch", "job.sh").stdout)[0]
        while not any((self.folder / "slurm" / ".sweep").glob("chunks/*")):
            time.sleep(0.05)
        self.run_here("scancel", "--signal=KILL", job)
        while self.run_here("squeue", "--noheader", f"--jobs={job}", check=False).stdout.strip():
            time.sleep(0.2)
        self.assertFalse((self.folder / "slurm" / "sweep.npz").exists(), "the sweep was over before it was killed")
        self.run_here("sbatch", "--wait", "job.sh")
        self.assertEqual(self.table("slurm"), self.table("alone"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
