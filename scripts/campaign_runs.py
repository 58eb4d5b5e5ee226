"""What the campaigns have in common: the tool's processes, recordings of scenarios, many jobs at a time, options."""
import argparse
import concurrent.futures
import csv
import os
import pathlib
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


class RunFailed(Exception):
    def __init__(self, message, code=None):
        super().__init__(message)
        self.code = code  # exit code of the tool, below 0 the signal that ended it


class Interrupted(Exception):
    pass


class Runner:
    """Runs the tool's processes, each job on a core of its own, and ends them when the campaign is interrupted."""

    def __init__(self, tool, jobs):
        self.tool = tool
        self.lock = threading.Lock()
        self.running = set()
        self.stopped = False
        cores = sorted(os.sched_getaffinity(0))
        self.cores = queue.SimpleQueue()
        for job in range(jobs):
            self.cores.put(cores[job % len(cores)])

    def call(self, core, *arguments):
        command = ["taskset", "--cpu-list", str(core), self.tool, *map(str, arguments)]
        with self.lock:
            if self.stopped:
                raise Interrupted
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.running.add(process)
        try:
            output, _ = process.communicate()
        finally:
            with self.lock:
                self.running.discard(process)
        if self.stopped:
            raise Interrupted
        if process.returncode != 0:
            last = output.strip().splitlines()[-1:] or ["no message"]
            raise RunFailed(f"{' '.join(map(str, command[3:]))}: exit code {process.returncode}: {last[0]}",
                            process.returncode)

    def stop(self):
        with self.lock:
            self.stopped = True
            for process in self.running:
                process.terminate()


class Progress:
    """How much is done and how long the rest takes, on standard error."""

    def __init__(self, frames):
        self.frames, self.done, self.started = frames, 0, time.monotonic()
        self.over = sys.stderr.isatty()
        self.lock = threading.Lock()

    def add(self, frames, what):
        with self.lock:
            self.done += frames
            left = (time.monotonic() - self.started) * (self.frames - self.done) / self.done
            line = f"{100 * self.done // self.frames} % of {self.frames} frames, {left / 60:.0f} min to go; {what}"
            print(f"\r\033[K{line}" if self.over else line, end="" if self.over else "\n", file=sys.stderr, flush=True)

    def end(self):
        if self.over:
            print(file=sys.stderr)


def list_scenarios(tool):
    """What the tool can simulate: name, frames, whether the ship of the map lies there, whether the air is clear."""
    answer = subprocess.run([tool, "simulate", "--list", "--csv"], stdout=subprocess.PIPE, text=True, check=True)
    return [{"name": row["name"], "frames": int(row["frames"]), "mapped": row["mapped_ship"] == "1",
             "clear": row["clear"] == "1"} for row in csv.DictReader(answer.stdout.splitlines())]


def recording(runner, core, folder, scenario, seed, options):
    """Simulates one into `folder` unless it holds a whole one; half of one is not left behind."""
    if (folder / "returns.csv").exists():  # the last one that gets its name
        return
    lidars = [word for model in options.lidar for word in ("--lidar", model)]
    try:
        runner.call(core, "simulate", "--scenario", scenario["name"], *lidars, "--returns", options.returns,
                    "--seed", seed, "--frames", scenario["frames"], "--force", "--out", folder)
    except (RunFailed, Interrupted):
        shutil.rmtree(folder)
        raise


def run_all(runner, scenarios, options, scratch, work, steps):
    """Calls work(core, folder, scenario, seed, step) for each recording, on a core of its own; it may call step(what)
    up to `steps` times as it gets on. Results by (name of the scenario, seed), and what went wrong. After an interrupt
    work() may still return what it has."""
    results, failures = {}, []
    progress = Progress(steps * options.seeds * sum(s["frames"] for s in scenarios))

    def job(scenario, seed):
        name = f"{scenario['name']}-{'+'.join(options.lidar)}-{options.returns}-{scenario['frames']}-seed{seed}"
        folder = scratch / name
        folder.mkdir(parents=True, exist_ok=True)
        core = runner.cores.get()
        left = steps

        def step(what):
            nonlocal left
            left -= 1
            progress.add(scenario["frames"], f"{scenario['name']} seed {seed}{what}")

        try:
            recording(runner, core, folder, scenario, seed, options)
            return work(core, folder, scenario, seed, step)
        finally:
            runner.cores.put(core)
            if not options.keep:
                shutil.rmtree(folder, ignore_errors=True)
            if left and not runner.stopped:
                progress.add(left * scenario["frames"], f"{scenario['name']} seed {seed}")

    def collect(future, scenario, seed):
        try:
            results[scenario["name"], seed] = future.result()
        except (RunFailed, OSError, ValueError, KeyError) as failure:
            failures.append(f"{scenario['name']} seed {seed}: {failure!r}")
        except (Interrupted, concurrent.futures.CancelledError):
            pass

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        futures = {pool.submit(job, s, seed): (s, seed) for s in scenarios for seed in range(1, options.seeds + 1)}
        try:
            concurrent.futures.wait(futures)
        except KeyboardInterrupt:
            failures.append("interrupted")
            runner.stop()
            pool.shutdown(cancel_futures=True)
        progress.end()
    for future, of in futures.items():
        collect(future, *of)
    return results, failures


def build():
    subprocess.run(["cmake", "--preset", "release"], cwd=ROOT, check=True, stdout=sys.stderr)
    subprocess.run(["cmake", "--build", "--preset", "release", "--target", "hulltrack"], cwd=ROOT, check=True,
                   stdout=sys.stderr)
    return ROOT / "build" / "release"


def words(text):
    return text.split(",")


def count(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("must be at least 1")
    return number


def add_options(parser, seeds, scenarios, frames):
    """What every campaign can be told; `scenarios` and `frames` say what is done without."""
    parser.add_argument("--seeds", type=count, default=seeds, help=f"seeds 1 to N (default {seeds})")
    parser.add_argument("--scenarios", type=words, help=f"names, with commas between them (default {scenarios})")
    parser.add_argument("--lidar", type=words, default=["velodyne_vlp16"],
                        help="model, or two with a comma between them (default velodyne_vlp16)")
    parser.add_argument("--returns", choices=["strongest", "last", "dual"], default="strongest",
                        help="echoes that the LiDAR reports (default strongest)")
    parser.add_argument("--frames", type=count, help=frames)
    parser.add_argument("--jobs", type=count, default=len(os.sched_getaffinity(0)),
                        help="runs at a time (default: as many as there are cores)")
    parser.add_argument("--keep", type=pathlib.Path, metavar="FOLDER",
                        help="keep recordings and CSV files there, and use the recordings that it holds")
    parser.add_argument("--build", type=pathlib.Path, metavar="DIR",
                        help="build folder with daemon/hulltrack (default: builds the preset release)")
    parser.add_argument("--csv", type=pathlib.Path, metavar="FILE", help="write all columns there too, unrounded")
    parser.add_argument("--markdown", action="store_true", help="print the tables as Markdown")


def choose(scenarios, options, parser):
    """The scenarios that the options name."""
    unknown = set(options.scenarios or []) - {s["name"] for s in scenarios}
    if unknown:
        parser.error(f"--scenarios {','.join(sorted(unknown))}: choose from {','.join(s['name'] for s in scenarios)}")
    return [s for s in scenarios if not options.scenarios or s["name"] in options.scenarios]


def campaign(options, tool, scenarios, work, steps=1):
    """run_all() where the options say, on recordings that go away afterwards unless they are to be kept. `work` gets
    the runner first."""
    for interrupt in (signal.SIGINT, signal.SIGTERM):  # SIGINT too: a shell's background jobs begin without it
        signal.signal(interrupt, signal.default_int_handler)
    with tempfile.TemporaryDirectory(prefix="campaign-") as scratch:
        runner = Runner(tool, options.jobs)
        return run_all(runner, scenarios, options, options.keep or pathlib.Path(scratch),
                       lambda *arguments: work(runner, *arguments), steps)


def write_csv(path, rows):
    with open(path, "w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0])
        writer.writeheader()
        writer.writerows(rows)
