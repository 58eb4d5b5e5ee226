"""Two LiDARs on the boom, simulated and replayed: better than one, checking each other, one of them unplugged."""
import csv
import math
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import unittest

HULLTRACK = pathlib.Path(sys.argv.pop(1))
FRAMES, UNPLUGGED, BACK = 60, 3.0, 4.5  # s
TIMEOUT, RECOVERY = 0.5, 0.7            # s: timeout_ms; recover_frames and a frame more
SILENT = 1 << 3


def run(*arguments):
    done = subprocess.run([HULLTRACK, *map(str, arguments)], capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stderr


def read(path):
    with open(path, newline="") as stream:
        return list(csv.DictReader(stream))


class TwoLidars(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        models = ["--lidar", "velodyne_vlp16", "--lidar", "robosense_helios32"]
        common = ["simulate", "--scenario", "berth", "--seed", 2, "--frames", FRAMES]
        run(*common, *models[:2], "--out", cls.folder / "one")
        run(*common, *models, "--unplug", f"2@{UNPLUGGED}-{BACK}", "--out", cls.folder / "two")
        cls.one, _ = cls.replay("one")
        cls.two, cls.summary = cls.replay("two")

    @classmethod
    def replay(cls, recording, config="hulltrackd.toml"):
        """Frames with seconds since the first one's begin and, where there is a pose, its error; the summary."""
        folder = cls.folder / recording
        summary = run("replay", folder, "--config", folder / config, "--csv", folder / "frames.csv")
        truth = {row["t_ns"]: row for row in read(folder / "truth.csv")}
        frames = read(folder / "frames.csv")
        began = int(frames[0]["t_ns"]) - 50_000_000
        for frame in frames:
            frame["s"] = (int(frame["t_ns"]) - began) * 1e-9
            if frame["x"]:
                true = truth[frame["t_ns"]]
                frame["error"] = math.dist(*([float(table[axis]) for axis in "xyz"] for table in (frame, true)))
        return frames, summary

    def test_a_silent_one_is_named_and_no_frame_is_healthy_until_it_is_back(self):
        for frame in self.two:
            healthy, silent = frame["health"] == "1", int(frame["faults"]) & SILENT != 0
            if UNPLUGGED + TIMEOUT + 0.1 < frame["s"] < BACK:
                self.assertEqual((frame["state"], healthy, silent), ("2", False, True), frame)
                self.assertLess(frame["error"], 0.05, "the other one goes on")
            if frame["s"] > BACK + RECOVERY or 1.0 < frame["s"] < UNPLUGGED:
                self.assertEqual((healthy, silent), (True, False), frame)
            if healthy:
                self.assertLess(frame["error"], 0.05)
        self.assertRegex(self.summary, re.compile("^silent +LiDAR boom2 for longer than 500 ms in 1[01] frames$", re.M))

    def test_two_are_surer_than_one(self):
        # Translation is what the encoders leave of it; the hull's attitude is the LiDARs' alone, and two that are
        # alike should have 1 / sqrt(2) of one's sigma.
        def sigma(frames):
            return statistics.median(float(f["sigma_r"]) for f in frames if 1.0 < f["s"] < UNPLUGGED)
        self.assertLess(sigma(self.two), math.sqrt(0.5) * sigma(self.one))

    def test_mounts_that_contradict_each_other_give_no_health(self):
        text = (self.folder / "two" / "hulltrackd.toml").read_text()
        bent, changed = re.subn(r"(mount = .*-1\.900.*, )75\.000,", r"\g<1>75.500,", text)
        self.assertEqual(changed, 1)
        (self.folder / "two" / "bent.toml").write_text(bent)
        frames, _ = self.replay("two", "bent.toml")
        self.assertEqual([f["frame"] for f in frames if f["health"] == "1"], [])


if __name__ == "__main__":
    unittest.main()
